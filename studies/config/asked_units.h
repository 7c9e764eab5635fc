/// The units in which a verb shows its result.
#pragma once

#include "studies/config/loader.h"
#include "studies/config/value_reader.h"
#include "studies/files/shown_units.h"

namespace fingertip::studies::inline config {

/// What run.units says. It is no part of Config, so that no job can depend on it.
inline UnitSystem asked_units(const LoadedConfig& loaded) {
  return unit_system(unquoted(loaded.entries.at("run.units").literal));
}

}  // namespace fingertip::studies::inline config
