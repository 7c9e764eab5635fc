#include "studies/exchange/contact_source.h"

namespace fingertip::studies::inline exchange {

const SoftBody& ContactSource::soft() const {
  if (!soft_) soft_ = fitted_soft_body(loaded, curves.front());
  return *soft_;
}

}  // namespace fingertip::studies::inline exchange
