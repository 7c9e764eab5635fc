/// A number that counts what is done with it, in place of a register of doubles: the lattice's
/// kernels are templates over their register type, so their own source tells their operations.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace kernel_probes {

/// One lane. Additions, subtractions, multiplications, divisions, square roots, comparisons, minima
/// and maxima count one each; signs and magnitudes, which only touch a bit, nothing.
class Counted {
 public:
  /// What a comparison yields.
  struct Mask {
    bool set;
    friend Mask operator&&(Mask a, Mask b) { return {a.set && b.set}; }
    friend bool all_of(Mask a) { return a.set; }
    friend bool any_of(Mask a) { return a.set; }
  };

  inline static double operations = 0.0;

  Counted() = default;
  Counted(double v) : value_(v) {}
  template <typename Flags>
  Counted(const double* from, const Flags&) : value_(*from) {}
  template <typename Flags>
  void copy_to(double* to, const Flags&) const {
    *to = value_;
  }
  static constexpr std::size_t size() { return 1; }
  double operator[](std::size_t) const { return value_; }

  /// For shuffles between registers: raw vectors of one lane.
  using Raw [[gnu::vector_size(sizeof(double))]] = double;
  explicit Counted(Raw raw) : value_(raw[0]) {}
  explicit operator Raw() const { return Raw{value_}; }

  Counted operator-() const { return -value_; }
  Counted& operator+=(Counted b) { return *this = *this + b; }
  Counted& operator-=(Counted b) { return *this = *this - b; }
  Counted& operator*=(Counted b) { return *this = *this * b; }
  friend Counted operator+(Counted a, Counted b) { return counted(a.value_ + b.value_); }
  friend Counted operator-(Counted a, Counted b) { return counted(a.value_ - b.value_); }
  friend Counted operator*(Counted a, Counted b) { return counted(a.value_ * b.value_); }
  friend Counted operator/(Counted a, Counted b) { return counted(a.value_ / b.value_); }
  friend Mask operator==(Counted a, Counted b) { return compared(a.value_ == b.value_); }
  friend Mask operator<(Counted a, Counted b) { return compared(a.value_ < b.value_); }
  friend Mask operator>(Counted a, Counted b) { return compared(a.value_ > b.value_); }
  friend Mask operator<=(Counted a, Counted b) { return compared(a.value_ <= b.value_); }
  friend Mask operator>=(Counted a, Counted b) { return compared(a.value_ >= b.value_); }
  friend Counted sqrt(Counted a) { return counted(std::sqrt(a.value_)); }
  friend Counted min(Counted a, Counted b) { return counted(std::min(a.value_, b.value_)); }
  friend Counted max(Counted a, Counted b) { return counted(std::max(a.value_, b.value_)); }
  friend Counted abs(Counted a) { return std::abs(a.value_); }
  friend double hmin(Counted a) { return a.value_; }
  friend double hmax(Counted a) { return a.value_; }

 private:
  static Counted counted(double value) {
    ++operations;
    return value;
  }
  static Mask compared(bool value) {
    ++operations;
    return {value};
  }
  double value_ = 0.0;
};

/// Assignment to the lanes for which `mask` holds.
class Selected {
 public:
  Selected(Counted::Mask mask, Counted& target) : mask_(mask.set), target_(target) {}
  void operator=(Counted value) const {
    if (mask_) target_ = value;
  }

 private:
  bool mask_;
  Counted& target_;
};

inline Selected where(Counted::Mask mask, Counted& target) {
  return {mask, target};
}

}  // namespace kernel_probes
