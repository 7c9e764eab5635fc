/// The last words of a press that found equilibrium no further.
#pragma once

#include "meshes/base/errors.h"
#include "meshes/press/press_protocol.h"

namespace fingertip::meshes::inline press {

/// A press went down to an indentation, and no further.
class NoEquilibrium : public NotConverged {
 public:
  /// In another's words.
  NoEquilibrium(const std::string& text, double indentation)
      : NotConverged(text), indentation_(indentation) {}
  /// `who` pressed; `why`: the solver's last words, may be empty; `remedy`: what else may help than
  /// to press less deep, or to move less far along the plane.
  NoEquilibrium(const std::string& who, const PressPose& pose, const std::string& why,
                const std::string& remedy);
  double indentation() const { return indentation_; }  ///< the deepest that was found [m]

 private:
  double indentation_;
};

}  // namespace fingertip::meshes::inline press
