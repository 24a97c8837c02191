#include "butee/config/parameters.hpp"

#include <algorithm>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"

namespace butee::config {

bool Parameters::has(std::string_view name) const {
  return entries_.find(name) != entries_.end();
}

bool Parameters::given(std::string_view name) const {
  const auto found = entries_.find(name);
  return found != entries_.end() && found->second.from_file;
}

const Value& Parameters::value(std::string_view name) const {
  const auto found = entries_.find(name);
  if (found == entries_.end()) throw LogicError("parameter \"" + std::string(name) + "\" has no value");
  return found->second.value;
}

double Parameters::number(std::string_view name) const {
  const auto number = as_number(value(name));
  if (!number) throw LogicError("parameter \"" + std::string(name) + "\" is not a number");
  return *number;
}

Index Parameters::integer(std::string_view name) const {
  return std::get<std::int64_t>(value(name).data);
}
bool Parameters::flag(std::string_view name) const {
  return std::get<bool>(value(name).data);
}
const std::string& Parameters::text(std::string_view name) const {
  return std::get<std::string>(value(name).data);
}

std::vector<double> Parameters::numbers(std::string_view name) const {
  std::vector<double> list;
  for (const Value& item : std::get<Array>(value(name).data)) list.push_back(as_number(item).value());
  return list;
}

Eigen::MatrixXd Parameters::matrix(std::string_view name) const {
  const auto& rows = std::get<Array>(value(name).data);
  const auto columns = rows.empty() ? std::size_t{0} : std::get<Array>(rows.front().data).size();
  Eigen::MatrixXd matrix(static_cast<Index>(rows.size()), static_cast<Index>(columns));
  for (Index i = 0; i < matrix.rows(); ++i)
    for (Index j = 0; j < matrix.cols(); ++j)
      matrix(i, j) =
          as_number(std::get<Array>(rows[static_cast<std::size_t>(i)].data)[static_cast<std::size_t>(j)]).value();
  return matrix;
}

std::vector<std::string> Parameters::texts(std::string_view name) const {
  const Value& given = value(name);
  if (const std::string* single = given.text()) return {*single};
  std::vector<std::string> list;
  for (const Value& item : std::get<Array>(given.data)) list.push_back(std::get<std::string>(item.data));
  return list;
}

std::string Parameters::key(std::string_view name) const {
  return path_.empty() ? std::string(name) : path_ + "." + std::string(name);
}

void Parameters::complain(Diagnostics& diagnostics, std::string_view name, const std::string& complaint) const {
  if (given(name))
    diagnostics.error(key(name), value(name), complaint);
  else
    diagnostics.error(key(name), at_, complaint);
}

void Parameters::set(const std::string& name, Value value, bool from_file) {
  entries_.insert_or_assign(name, Entry{std::move(value), from_file});
}

void Parameters::place(std::string path, Location at) {
  path_ = std::move(path);
  at_ = at;
}

std::optional<double> as_number(const Value& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value.data)) return static_cast<double>(*integer);
  if (const auto* number = std::get_if<double>(&value.data)) return *number;
  return std::nullopt;
}

std::optional<Parameters> read_parameters(const Value& value, const std::string& path,
                                          const std::vector<Parameter>& declared, Diagnostics& diagnostics,
                                          const std::vector<std::string>& ignored) {
  const Table* table = value.table();
  if (table == nullptr) {
    diagnostics.error(path, value, std::string("must be a table, not ") + value.kind());
    return std::nullopt;
  }
  const std::size_t errors_before = diagnostics.error_count();
  Parameters parameters;
  parameters.place(path, value.at);
  const std::string prefix = path.empty() ? "" : path + ".";
  std::vector<std::string> known = names_of(declared);
  for (const std::string& key : ignored)
    if (std::find(known.begin(), known.end(), key) == known.end()) known.push_back(key);

  // A required key that is meant by a wrong one counts as a single mistake.
  std::vector<std::string> meant;
  for (const auto& [key, item] : table->entries)
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      diagnostics.error(prefix + key, item, "unknown key" + suggestion(key, known) + "; known here: " + join(known));
      meant.push_back(closest_name(key, known));
    }
  for (const Parameter& parameter : declared) {
    const Value* given = table->find(parameter.name);
    if (given != nullptr) {
      if (const std::string wrong = parameter.complaint(*given); !wrong.empty())
        diagnostics.error(prefix + parameter.name, *given, wrong);
      else
        parameters.set(parameter.name, *given, true);
    } else if (parameter.fallback) {
      parameters.set(parameter.name, *parameter.fallback, false);
    } else if (parameter.required && std::find(meant.begin(), meant.end(), parameter.name) == meant.end()) {
      const std::string unit = parameter.unit.empty() || parameter.unit == "1" ? "" : ", " + parameter.unit;
      diagnostics.error(prefix + parameter.name, value.at,
                        "missing; give " + parameter.help + " (" + parameter.describe() + unit + ")");
    }
  }
  if (diagnostics.error_count() > errors_before) return std::nullopt;
  return parameters;
}

Parameters make_parameters(const std::vector<Parameter>& declared, const Table& given) {
  const Document document{{"parameters"}, Value(given)};
  Diagnostics diagnostics(document);
  auto parameters = read_parameters(document.root, "", declared, diagnostics);
  diagnostics.throw_if_any();
  return std::move(*parameters);
}

}  // namespace butee::config
