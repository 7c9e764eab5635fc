/// Faster fixed points.
#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <vector>

namespace fingertip::fem_reference::inline contact {

/// Anderson's mixing (J. ACM 12 (1965) 547) for x = g(x): the next x is that at which g would stand
/// still, were it linear through the last images. It converges where plain iteration would be slow,
/// or run away along a few directions.
class AndersonMixing {
 public:
  /// From x and its image g(x); of the size of those before, or `forget` them first.
  Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd& image) {
    constexpr std::size_t most = 10;  // what it remembers
    const Eigen::VectorXd left = image - x;
    if (last_image_.size() > 0) {
      image_changes_.push_back(image - last_image_);
      left_changes_.push_back(left - last_left_);
      if (image_changes_.size() > most) {
        image_changes_.erase(image_changes_.begin());
        left_changes_.erase(left_changes_.begin());
      }
    }
    last_image_ = image;
    last_left_ = left;
    if (image_changes_.empty()) return image;
    const auto columns = Eigen::Index(image_changes_.size());
    Eigen::MatrixXd images(x.size(), columns), changes(x.size(), columns);
    for (Eigen::Index i = 0; i < columns; ++i) {
      images.col(i) = image_changes_[std::size_t(i)];
      changes.col(i) = left_changes_[std::size_t(i)];
    }
    return image - images * changes.colPivHouseholderQr().solve(left);
  }
  void forget() { *this = {}; }

 private:
  Eigen::VectorXd last_image_, last_left_;
  std::vector<Eigen::VectorXd> image_changes_, left_changes_;
};

}  // namespace fingertip::fem_reference::inline contact
