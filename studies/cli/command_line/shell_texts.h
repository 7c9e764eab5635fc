/// What the shell knows of the program: a manual page and completion, from verbs and key table.
#pragma once

#include <string>

namespace fingertip::studies::inline cli::inline command_line {

/// In man's language, section 1.
std::string man_page();

/// For bash to source: verbs, their options and choices, keys after --set, words of a key after its
/// =.
std::string bash_completion();

}  // namespace fingertip::studies::inline cli::inline command_line
