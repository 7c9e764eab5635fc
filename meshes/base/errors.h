/// The three ways a computation can end other than well. Every library throws these, and the
/// programs map them to exit codes: InvalidInput 2, NotConverged 3, Interrupted 130.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace fingertip::meshes::inline base {

/// One broken rule, in words a user can act on.
struct Violation {
  std::string key;         ///< configuration key, e.g. "rubber.shear_modulus", or a file name
  std::string value;       ///< the offending value as the user would recognise it
  std::string rule;        ///< what must hold, e.g. "G must exceed E/3"
  std::string remedy;      ///< what to do about it
  std::string place = {};  ///< where it was written: "file.toml:12", "--set ..."; may be empty
};

/// "place: key = value: rule; remedy", the form in which every violation is shown.
std::string to_string(const Violation& violation);
/// The same without the remedy.
std::string without_remedy(const Violation& violation);

/// Adds what else is broken.
inline void append(std::vector<Violation>& found, const std::vector<Violation>& more) {
  found.insert(found.end(), more.begin(), more.end());
}

/// The input breaks at least one rule; nothing has been computed.
class InvalidInput : public std::runtime_error {
 public:
  explicit InvalidInput(std::vector<Violation> violations);
  explicit InvalidInput(Violation violation);
  const std::vector<Violation>& violations() const { return violations_; }

 private:
  std::vector<Violation> violations_;
};

/// A solver stopped short of its tolerance; what was finished before is kept.
class NotConverged : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The user asked the run to stop; what was finished before is kept.
class Interrupted : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace fingertip::meshes::inline base
