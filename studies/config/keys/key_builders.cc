#include "studies/config/keys/key_builders.h"

#include "calibration/files/words.h"
#include "meshes/base/files.h"
#include "studies/config/text/units.h"

namespace fingertip::studies::inline config::inline keys {

std::string number_literal(double value) {
  std::string text = meshes::to_text(value);
  if (text.find_first_of(".e") == text.npos) text += ".0";
  if (const auto at = text.find("e+"); at != text.npos) text.erase(at + 1, 1);
  for (auto at = text.find("e"); at != text.npos;) {
    const auto zero = text.find_first_not_of('-', at + 1);
    if (zero + 1 >= text.size() || text[zero] != '0') break;
    text.erase(zero, 1);
  }
  return text;
}

std::string quantity_literal(double value, const std::string& unit, const std::string& shown) {
  const double number = value / parse_quantity("1 " + shown, unit, "1 " + shown);
  return '"' + calibration::rounded(number, 12) + ' ' + shown + '"';
}

}  // namespace fingertip::studies::inline config::inline keys
