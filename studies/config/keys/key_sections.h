/// The parts of the key table (studies/config/keys/key_table.h joins them).
#pragma once

#include <vector>

#include "studies/config/keys/key.h"

namespace fingertip::studies::inline config::inline keys {

std::vector<Key> specimen_keys();     ///< [geometry] [rubber] [rod]
std::vector<Key> lattice_keys();      ///< [lattice]
std::vector<Key> press_keys();        ///< [press]
std::vector<Key> obstacle_keys();     ///< [obstacle]
std::vector<Key> controller_keys();   ///< [controller]
std::vector<Key> hardware_keys();     ///< [hardware]
std::vector<Key> sensor_keys();       ///< [sensor]
std::vector<Key> grasp_keys();        ///< [grasp]
std::vector<Key> reference_keys();    ///< [reference]
std::vector<Key> calibration_keys();  ///< [calibration]
std::vector<Key> exchange_keys();     ///< [exchange]
std::vector<Key> run_keys();          ///< [run]

}  // namespace fingertip::studies::inline config::inline keys
