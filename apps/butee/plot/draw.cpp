#include "draw.hpp"

#include <algorithm>
#include <filesystem>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>

#include "../gnuplot.hpp"
#include "contact_pictures.hpp"
#include "frame.hpp"
#include "shape.hpp"

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

void check_probes(const Request& request, const std::vector<Result>& results) {
  std::vector<std::string> known;
  for (const Result& result : results)
    for (const Probe& probe : result.probes)
      if (std::find(known.begin(), known.end(), probe.label) == known.end()) known.push_back(probe.label);
  for (const std::string& label : request.probes)
    if (std::find(known.begin(), known.end(), label) == known.end())
      throw InputError("--probe " + label + ": there is no such probe" + suggestion(label, known) +
                       "; known: " + join(known));
}

std::vector<Picture> shapes(Kind kind, const Result& result, const plugin::Catalogue& catalogue, Window window,
                            bool several, bool asked_for) {
  if (result.field_format.empty()) return {};
  const auto* format = model::find_type(catalogue.types().formats, result.field_format);
  if (format == nullptr) {
    const std::string reason = result.folder + ": its fields are in the format " + result.field_format +
                               ", whose module is not installed (hdf5: install libhdf5-dev and build butee again)";
    if (asked_for) throw InputError(reason);
    log::warning(reason);
    return {};
  }
  if (kind == Kind::frame) return frame_pictures(result, *format->open(result.folder), window, several);
  return shape_pictures(result, *format->open(result.folder), window, several);
}

std::string folder_of(const Request& request) {
  if (!request.output.empty()) return request.output;
  return request.folders.size() == 1 ? (fs::path(request.folders.front()) / "plots").string() : "plots";
}

}  // namespace

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
  const std::vector<Result> results = read_results(request, catalogue);
  check_probes(request, results);
  const bool chosen = !request.kinds.empty();
  std::vector<Picture> all;
  for (const std::string& name : chosen ? request.kinds : kind_names()) {
    const Kind kind = kind_of(name);
    std::vector<Picture> found;
    if (kind == Kind::shape || kind == Kind::frame) {
      for (const Result& result : results)
        if (chosen || results.size() == 1)
          for (Picture& picture : shapes(kind, result, catalogue, request.window, results.size() > 1, chosen))
            found.push_back(std::move(picture));
    } else if (kind == Kind::contact_map || kind == Kind::wear) {
      for (const Result& result : results)
        for (Picture& picture : kind == Kind::wear ? wear_picture(result, results.size() > 1)
                                                   : contact_map(result, request.window, results.size() > 1))
          found.push_back(std::move(picture));
    } else {
      found = pictures(kind, results, request.probes);
    }
    if (found.empty() && chosen)
      throw InputError("--kind " + name + ": " + join(request.folders) + " lacks " + requirement_of(kind));
    for (Picture& picture : found) all.push_back(std::move(picture));
  }
  if (all.empty()) throw InputError(join(request.folders) + ": there is nothing to draw");

  std::vector<std::string> drawn_formats = request.formats, made;
  std::erase(drawn_formats, kScript);
  const std::string folder = folder_of(request);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw RunError(folder + ": cannot be created: " + error.message());
  for (const Picture& picture : all) {
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
