#include "gnuplot.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <butee/core/error.hpp>
#include <butee/core/text.hpp>

namespace butee::app::gnuplot {
namespace {

/// Terminal settings for a picture 800 points wide, independent of the format's definition of a point.
std::string terminal(const std::string& format, double shape) {
  const auto size = [&](double width) { return to_short_text(width) + "," + to_short_text(std::round(width * shape)); };
  if (format == "png") return "pngcairo size " + size(1600) + " font 'sans,10.5' fontscale 2 linewidth 2 pointscale 2";
  if (format == "svg") return "svg size " + size(800) + " font 'sans,14' background 'white' standalone";
  if (format == "pdf")
    return "pdfcairo size 16cm," + to_short_text(16 * shape) +
           "cm font 'sans,6.4' fontscale 1 linewidth 1.2 pointscale 0.6";
  throw LogicError("no such format of pictures");
}

/// Quotes text as one word of a command line of sh.
std::string shell_word(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

bool is_installed() {
  return std::system("command -v gnuplot >/dev/null 2>&1") == 0;
}

std::string remedy() {
  return "gnuplot is not found; install it (Debian: gnuplot-nox)";
}

std::vector<std::string> formats() {
  return {"png", "svg", "pdf"};
}

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += '\'';
    out += c == '\n' ? ' ' : c;
  }
  return out + "'";
}

std::string style() {
  return "set encoding utf8\n"
         "set border 3 lw 0.8 lc rgb '#444444'\n"
         "set tics nomirror out scale 0.6\n"
         "set grid xtics ytics lt 1 lw 0.5 lc rgb '#dddddd'\n"
         "set key noenhanced\n"
         "set style increment user\n";
}

std::string legend_below(const std::vector<std::string>& entries) {
  constexpr std::size_t kWidth = 82, kSample = 7;  // characters: picture, legend entry before its text
  std::size_t longest = 1;
  for (const std::string& entry : entries) longest = std::max(longest, entry.size());
  const std::size_t count = std::max<std::size_t>(entries.size(), 1);
  const std::size_t fitting = std::max<std::size_t>(kWidth / (longest + kSample), 1);
  const std::size_t rows = (count + fitting - 1) / fitting, columns = (count + rows - 1) / rows;
  std::ostringstream out;
  // Fractions of the picture's height: axis with title, one row of the legend.
  out << "set bmargin at screen " << 0.162 + 0.043 * static_cast<double>(rows)
      << "\nset key at screen 0.5, screen 0.015 bottom center "
      << "horizontal Left reverse samplen 2 width 1 maxcols " << columns << "\n";
  return out.str();
}

std::string draw_into(const std::vector<std::string>& formats, const std::string& name, const std::string& plot,
                      double shape) {
  std::string text;
  for (const std::string& format : formats) {
    text += "set terminal " + terminal(format, shape) + "\nset output " + quoted(name + "." + format) + "\n";
    text += plot + "\n";
  }
  return text + "set output\n";
}

std::string file_name(std::string text) {
  for (char& c : text)
    if (c == '/' || c == '\\' || std::iscntrl(static_cast<unsigned char>(c)) != 0) c = '_';
  return text;
}

void write_script(const std::string& folder, const std::string& name, const std::string& text) {
  const std::string path = folder + "/" + name + ".gp";
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw RunError(path + ": cannot be written");
}

std::string run_script(const std::string& folder, const std::string& name) {
  const std::string messages = folder + "/" + name + ".log";
  const std::string command = "CDPATH= cd -- " + shell_word(folder) + " && gnuplot " + shell_word(name + ".gp") +
                              " > " + shell_word(name + ".log") + " 2>&1 </dev/null";
  const bool ok = std::system(command.c_str()) == 0;
  std::ostringstream text;
  text << std::ifstream(messages).rdbuf();
  std::error_code ignored;
  std::filesystem::remove(messages, ignored);
  if (ok) return "";
  return text.str().empty() ? "gnuplot failed without a reason" : text.str();
}

}  // namespace butee::app::gnuplot
