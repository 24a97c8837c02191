#include "draw.hpp"

#include <algorithm>
#include <filesystem>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>

#include "../gnuplot.hpp"
#include "kinds.hpp"

namespace butee::app::plot {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScript = "script";

std::vector<Result> read_results(const Request& request, const plugin::Catalogue& catalogue) {
  std::vector<Result> results;
  for (const std::string& folder : request.folders) results.push_back(read_result(folder, catalogue, request.window));
  make_labels_unique(results);
  for (const Result& result : results)
    if (result.history.rows() == 0 && result.field_format.empty())
      throw InputError(result.folder + ": history.csv has no rows between --from and --to");
  return results;
}

/// All labels of the results' probes, in order.
std::vector<std::string> labels_of(const std::vector<Result>& results) {
  std::vector<std::string> labels;
  for (const Result& result : results)
    for (const Probe& probe : result.probes)
      if (std::find(labels.begin(), labels.end(), probe.label) == labels.end()) labels.push_back(probe.label);
  return labels;
}

void check_probes(const std::vector<std::string>& labels, const std::vector<std::string>& known) {
  for (const std::string& label : labels)
    if (std::find(known.begin(), known.end(), label) == known.end())
      throw InputError("--probe " + label + ": there is no such probe" + suggestion(label, known) +
                       "; known: " + join(known));
}

std::string folder_of(const Request& request) {
  if (!request.output.empty()) return request.output;
  return request.folders.size() == 1 ? (fs::path(request.folders.front()) / "plots").string() : "plots";
}

}  // namespace

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const Kind& kind : named_kinds()) names.push_back(kind.name);
  return names;
}

std::vector<std::string> picture_formats() {
  auto all = gnuplot::formats();
  all.emplace_back(kScript);
  return all;
}

void require_gnuplot(const std::vector<std::string>& formats) {
  const bool needed = std::any_of(formats.begin(), formats.end(), [](const auto& f) { return f != kScript; });
  if (needed && !gnuplot::is_installed())
    throw InputError(gnuplot::remedy() + ", or use --format script to write only the scripts and draw them elsewhere");
}

std::vector<std::string> draw(const Request& request, const plugin::Catalogue& catalogue) {
  require_gnuplot(request.formats);
  const bool chosen = !request.kinds.empty();
  std::vector<Kind> kinds;
  for (const std::string& name : request.kinds) kinds.push_back(kind_of(name));
  const std::vector<Result> results = read_results(request, catalogue);
  const std::vector<std::string> labels = labels_of(results);
  check_probes(request.probes, labels);
  if (!chosen) kinds = default_kinds(results);
  const Drawing drawing{results, request.probes.empty() ? labels : request.probes, request.window, chosen, catalogue};
  std::vector<Picture> all;
  std::vector<std::string> missing;
  for (const Kind& kind : kinds) {
    std::vector<Picture> found = kind.draw(drawing);
    if (found.empty() && chosen)
      missing.push_back("--kind " + kind.name + ": " + join(request.folders) + " lacks " + kind.needs);
    for (Picture& picture : found) all.push_back(std::move(picture));
  }
  if (all.empty() && !missing.empty()) throw InputError(join(missing, "\n"));
  for (const std::string& one : missing) log::warning(one);
  if (all.empty()) throw InputError(join(request.folders) + ": there is nothing to draw");

  std::vector<std::string> drawn_formats = request.formats, made;
  std::erase(drawn_formats, kScript);
  const std::string folder = folder_of(request);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw RunError(folder + ": cannot be created: " + error.message());
  for (Picture& picture : all) {
    picture.name = gnuplot::file_name(picture.name);
    const std::string path = (fs::path(folder) / picture.name).string();
    gnuplot::write_script(folder, picture.name,
                          picture.script(drawn_formats.empty() ? gnuplot::formats() : drawn_formats));
    if (drawn_formats.empty()) {
      made.push_back(path + ".gp");
      continue;
    }
    const std::string complaint = gnuplot::run_script(folder, picture.name);
    if (!complaint.empty()) throw RunError("gnuplot could not draw " + path + ".gp: " + complaint);
    for (const std::string& format : drawn_formats) made.push_back(path + "." + format);
  }
  return made;
}

}  // namespace butee::app::plot
