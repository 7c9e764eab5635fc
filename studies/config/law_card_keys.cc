#include "studies/config/law_card_keys.h"

#include <cmath>

#include "calibration/files/words.h"
#include "meshes/base/files.h"

namespace fingertip::studies::inline config {

using calibration::CardValue;
using calibration::LawCard;
using meshes::RubberLaw;

namespace {

std::string pascals(double value) {
  return '"' + meshes::to_text(value) + " Pa\"";
}

std::string pascal_list(const std::vector<CardValue>& values) {
  std::string list;
  for (const CardValue& value : values) list += (list.empty() ? "" : ", ") + pascals(value.value);
  return '[' + list + ']';
}

}  // namespace

std::string branches_literal(const std::vector<meshes::RelaxationBranch>& branches) {
  std::string list;
  for (const meshes::RelaxationBranch& branch : branches)
    list += (list.empty() ? "[" : ", [") + meshes::to_text(branch.share) + ", \"" +
            meshes::to_text(branch.time) + " s\"]";
  return '[' + list + ']';
}

std::vector<std::pair<std::string, std::string>> keys_of(const LawCard& card) {
  const auto& c = card.coefficients;
  std::vector<std::pair<std::string, std::string>> keys = {
      {"rubber.law", '"' + std::string(name(card.choice.law)) + '"'}};
  switch (card.choice.law) {
    case RubberLaw::yeoh: keys.emplace_back("rubber.yeoh", pascal_list(c)); break;
    case RubberLaw::mooney_rivlin: keys.emplace_back("rubber.mooney_rivlin", pascal_list(c)); break;
    case RubberLaw::ogden: {
      std::string list;
      for (std::size_t i = 0; i + 1 < c.size(); i += 2)
        list += (list.empty() ? "[" : ", [") + pascals(c[i].value) + ", " +
                meshes::to_text(c[i + 1].value) + ']';
      keys.emplace_back("rubber.ogden", '[' + list + ']');
      break;
    }
    case RubberLaw::gent:
      keys.emplace_back("rubber.gent_jm", meshes::to_text(c[1].value));
      [[fallthrough]];
    default: keys.emplace_back("rubber.shear_modulus", pascals(c[0].value));
  }
  if (card.bulk_modulus) {
    keys.emplace_back("rubber.bulk_modulus", pascals(card.bulk_modulus->value));
    keys.emplace_back("rubber.volumetric",
                      '"' + std::string(name(card.law().energy.volumetric)) + '"');
  }
  if (const meshes::Relaxation relaxation = card.relaxation(); !relaxation.empty()) {
    keys.emplace_back("rubber.relaxation", branches_literal(relaxation.branches));
    keys.emplace_back("rubber.relaxation_bulk", relaxation.bulk ? "true" : "false");
  }
  return keys;
}

std::vector<std::string> card_warnings(const LawCard& card, const LoadedConfig& loaded) {
  const auto& press = loaded.config.press;
  std::optional<std::array<double, 2>> used;
  const auto& samples = press.protocol.samples;
  const double depth = samples.empty() ? press.protocol.depth : samples.back();
  if (press.geometry.is_dome() && depth < press.geometry.thickness()) {
    const double along = 1.0 - depth / press.geometry.thickness();
    used = {along, 1.0 / std::sqrt(along)};
  }
  std::vector<std::string> found = calibration::warnings(card, used);
  const double duration = depth / press.protocol.speed;
  if (card.times && !press.rubber.relaxation.empty() &&
      (duration < (*card.times)[0] || duration > (*card.times)[1]))
    found.insert(found.begin(), "pressing takes " + calibration::rounded(duration, 3) +
                                    " s, and the tests tell how stress fades from " +
                                    calibration::rounded((*card.times)[0], 3) + " to " +
                                    calibration::rounded((*card.times)[1], 3) +
                                    " s: beyond, it is a guess");
  return found;
}

}  // namespace fingertip::studies::inline config
