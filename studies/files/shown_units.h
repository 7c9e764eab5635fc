/// Units in which people read results: one table for screens, pages, figures and the live view.
/// Files are SI, or name their unit. Which system it is belongs to the presentation alone (key
/// run.units), like a language: no result and no cached entry depends on it.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "meshes/base/names.h"

namespace fingertip::studies::inline files {

enum class UnitSystem {
  si,     ///< mN, mm, kPa
  paper,  ///< gf, cm, gf/cm², as in Reznik & Laugier (1996)
};
using meshes::name, meshes::values;
/// The words for them in run.units.
constexpr auto names_of(UnitSystem) {
  using enum UnitSystem;
  return meshes::names<UnitSystem>({{si, "si"}, {paper, "paper"}});
}
/// The system of that name; SI for any other word.
UnitSystem unit_system(std::string_view name);

/// How a quantity is shown.
struct ShownUnit {
  std::string_view quantity;  ///< "stress"
  std::string_view si;        ///< its unit in files
  std::string_view name;      ///< as it is printed, "gf/cm²"
  std::string_view ascii;     ///< on a terminal, "gf/cm^2"
  double factor;              ///< from SI

  double operator()(double value) const { return factor * value; }
  /// "depth [mm]", for axes and columns.
  std::string label(std::string_view what) const;
  /// "3 mm" of a value in SI, four digits.
  std::string text(double value) const;
};

struct ShownUnits {
  UnitSystem system;
  ShownUnit length, force, stress, stiffness, torque, speed, compliance, force_rate;

  std::array<const ShownUnit*, 8> all() const;
  /// That of a quantity whose unit in files is `si`; null when the table has none.
  const ShownUnit* of(std::string_view si) const;
};

const ShownUnits& units_of(UnitSystem system);

/// Those of today.
const ShownUnits& shown_units();

enum class Spelling { page, terminal };
/// Words of a result, whose amounts are in SI as files have them, with these as they are shown:
/// "E = 2.5e+05 Pa (95 %: 2.4e+05 to 2.6e+05)" becomes "E = 250 kPa (95 %: 240 to 260)". Digits are
/// kept, four at least, with the decimals that the largest of the three needs; units that the table
/// does not have stay.
std::string in_shown_units(std::string_view words, Spelling spelling);

/// Shows in `system` as long as this lives. For one thread at a time: pages and screens are made
/// by the thread that has started the verb.
class ShowIn {
 public:
  explicit ShowIn(UnitSystem system);
  ~ShowIn();
  ShowIn(const ShowIn&) = delete;
  ShowIn& operator=(const ShowIn&) = delete;

 private:
  UnitSystem before_;
};

}  // namespace fingertip::studies::inline files
