#pragma once

#include <string>
#include <vector>

namespace butee::test {

/// The result of a run of the program.
struct Outcome {
  int status = -1;
  std::string output, errors;
};

/// Runs `butee` with the arguments in `folder`, standard input closed, with a time limit.
Outcome run_program(const std::vector<std::string>& arguments, const std::string& folder,
                    const std::vector<std::string>& environment = {});

/// An empty folder, removed by the destructor.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  void write(const std::string& name, const std::string& text) const;
  std::vector<std::string> entries() const;

 private:
  std::string path_;
};

}  // namespace butee::test
