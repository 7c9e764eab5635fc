/// The one place where every configuration key is declared: name, kind, unit, default, range,
/// meaning and target. Parser, template, `explain`, JSON Schema and reference page follow from it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "studies/config/keys/key.h"

namespace fingertip::studies::inline config::inline keys {

/// All sections and keys in the order of the template.
const std::vector<Section>& sections();
const std::vector<Key>& key_table();

/// The key called "section.key"; nullptr when there is none.
const Key* find_key(std::string_view full_name);

/// The valid key nearest to `name`: one of which its last part is a part, else by edit distance
/// within its section.
std::string nearest_key(std::string_view name);

/// The nearest of `words` to `word` by edit distance.
std::string nearest_word(std::string_view word, const std::vector<std::string>& words);

}  // namespace fingertip::studies::inline config::inline keys
