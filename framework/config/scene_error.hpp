#pragma once

#include <string>
#include <utility>
#include <vector>

#include "butee/core/error.hpp"

namespace butee::config {

/// One mistake of a scene, in the parts of its message.
struct Mistake {
  std::string file;     ///< or "--set KEY=VALUE"
  int line = 0;         ///< from 1; 0 where the whole of `file` is meant
  std::string key;      ///< "contact[0].gap"
  std::string message;  ///< with the value in front of it, where there is one: "-1: must be at least 0"
};

/// Bad input with every mistake, in the order of the file.
class BUTEE_EXPORT SceneError : public InputError {
 public:
  SceneError(const std::string& text, std::vector<Mistake> mistakes)
      : InputError(text), mistakes_(std::move(mistakes)) {}

  const std::vector<Mistake>& mistakes() const { return mistakes_; }

 private:
  std::vector<Mistake> mistakes_;
};

}  // namespace butee::config
