#pragma once

#include <string>
#include <utility>
#include <vector>

#include "butee/core/error.hpp"

namespace butee::config {

/// One error in a scene, as the parts of its message.
struct Mistake {
  std::string file;     ///< or "--set KEY=VALUE"
  int line = 0;         ///< from 1; 0 if the error concerns the whole of `file`
  std::string key;      ///< "contact[0].gap"
  std::string message;  ///< preceded by the value, if there is one: "-1: must be at least 0"
};

/// Bad input with all errors, in the order of the file.
class BUTEE_EXPORT SceneError : public InputError {
 public:
  SceneError(const std::string& text, std::vector<Mistake> mistakes)
      : InputError(text), mistakes_(std::move(mistakes)) {}

  const std::vector<Mistake>& mistakes() const { return mistakes_; }

 private:
  std::vector<Mistake> mistakes_;
};

}  // namespace butee::config
