#include "studies/report/figure/format.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "studies/files/shown_units.h"

namespace {

using fingertip::studies::shown_units;
using fingertip::studies::report::number_with_error;

TEST(Format, AForceEndsWhereItsErrorBegins) {
  EXPECT_EQ(number_with_error(197.181, 0.59), "197.2");
  EXPECT_EQ(number_with_error(197.181, 0.59, 6), "197.18");
  EXPECT_EQ(number_with_error(19.4231, 1.3), "19.4");
  EXPECT_EQ(number_with_error(0.0123456, 0.0021), "0.0123");
  EXPECT_EQ(number_with_error(-19.4231, 1.3), "−19.4");
}

TEST(Format, AForceBelowItsErrorIsZeroWithoutSign) {
  EXPECT_EQ(number_with_error(-1e-12, 0.01), "0");
  EXPECT_EQ(number_with_error(-0.0, 0.01), "0");
  EXPECT_EQ(number_with_error(-0.0, 0.0), "0");
}

TEST(Format, WithoutAnErrorAllDigitsStay) {
  EXPECT_EQ(number_with_error(19.4231, std::nan("")), "19.42");
  EXPECT_EQ(number_with_error(19.4231, 0.0), "19.42");
  EXPECT_EQ(number_with_error(std::nan(""), 0.1), "–");
}

TEST(Format, AmountsInWordsAreShownInTheUnitsOfTheRun) {
  using namespace fingertip::studies;
  const std::string words =
      "modulus = 2.5891e+05 Pa (95 %: 2.5627e+05 to 2.6155e+05); touch = 0.00023094 m (95 %: "
      "-2.2741e-05 to 0.00023447). K1 m, 3 measured, 1.5 mm, 0.25 s, 40 Pa/s stay; k = 8.62 N/m, "
      "c = 5e-05 m/N, +-0.02 N, 1e999 Pa.";
  EXPECT_EQ(in_shown_units(words, Spelling::terminal),
            "modulus = 258.91 kPa (95 %: 256.27 to 261.55); touch = 0.23094 mm (95 %: -0.02274 to "
            "0.23447). K1 m, 3 measured, 1.5 mm, 0.25 s, 40 Pa/s stay; k = 8.62 N/m, c = 0.05 "
            "mm/N, +-20 mN, inf kPa.");
  // An estimate and its interval look alike, whatever their digits.
  EXPECT_EQ(
      in_shown_units("E = 1.1965e+07 Pa (95 %: 1.134e+07 to 1.259e+07), 2e+08 Pa, drift 0.0012 N/s",
                     Spelling::terminal),
      "E = 11965 kPa (95 %: 11340 to 12590), 200000 kPa, drift 1.2 mN/s");
  EXPECT_EQ(in_shown_units("touch = 0 m (95 %: -1e-07 to 1e-07)", Spelling::terminal),
            "touch = 0 mm (95 %: -0.0001 to 0.0001)");
  // No power of ten stands beside a number without one.
  EXPECT_EQ(in_shown_units("E = 1.1965e+07 Pa (95 %: 1.134e+07 to 9.99996e+08)", Spelling::page),
            "E = 11965 kPa (95 %: 11340 to 999996)");
  EXPECT_EQ(in_shown_units("E = 9.9996e+06 Pa, 2e+11 Pa", Spelling::page),
            "E = 9999.6 kPa, 2e+08 kPa");
  EXPECT_EQ(shown_units().stress.text(9.9997e6), "10000 kPa");
  EXPECT_EQ(shown_units().stress.text(1.23456e7), "12346 kPa");
  EXPECT_EQ(shown_units().stress.text(1234.56), "1.235 kPa");
  const ShowIn paper(UnitSystem::paper);
  EXPECT_EQ(in_shown_units("E = 3922.66 Pa", Spelling::terminal), "E = 40 gf/cm^2");
  EXPECT_EQ(in_shown_units("E = 3922.66 Pa", Spelling::page), "E = 40 gf/cm²");
}

}  // namespace
