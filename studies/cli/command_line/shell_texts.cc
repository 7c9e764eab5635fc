#include "studies/cli/command_line/shell_texts.h"

#include <fmt/format.h>

#include "studies/cli/command_line/command_line.h"
#include "studies/config/keys/key_table.h"
#include "studies/jobs/provenance.h"

namespace fingertip::studies::inline cli::inline command_line {

namespace {

/// Text that man must not take for its own words.
std::string roff(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\\')
      safe += "\\e";
    else if (c == '-')
      safe += "\\-";
    else if ((c == '.' || c == '\'') && safe.empty())
      safe += std::string("\\&") + c;
    else
      safe += c;
  }
  return safe;
}

std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : " ") + word;
  return all;
}

/// Words of a key's value that a shell can offer.
std::vector<std::string> words_of(const Key& key) {
  std::vector<std::string> words;
  if (key.kind == Kind::boolean) words = {"true", "false"};
  for (const Choice& choice : key.choices) words.push_back(choice.word);
  return words;
}

}  // namespace

std::string man_page() {
  std::string text = fmt::format(
      ".TH FINGERTIP 1 \"\" \"fingertip {}\" \"User Commands\"\n.SH NAME\nfingertip \\- a soft "
      "fingertip as a lattice of masses and springs, against its continuum\n.SH SYNOPSIS\n"
      ".B fingertip\n.I verb\n.RI [ options ]\n.SH VERBS\n",
      roff(program_version()));
  for (const VerbWords& verb : verb_words()) {
    text += fmt::format(".SS {} {}\n{}\n", roff(verb.name), roff(verb.argument), roff(verb.help));
    if (!verb.argument.empty())
      text += fmt::format(".TP\n.I {}\n{}\n", roff(verb.argument), roff(verb.argument_help));
    for (const VerbWords::Option& option : verb.options)
      text += fmt::format(".TP\n.BI {} \" {}\"\n{}{}\n", roff(option.name), roff(option.value),
                          roff(option.help),
                          option.choices.empty() ? "" : " (" + roff(joined(option.choices)) + ")");
  }
  text +=
      ".SH KEYS\nOf configuration files and of \\-\\-set section.key=value; quantities carry their "
      "unit.\n";
  for (const Section& section : sections()) {
    text += fmt::format(".SS [{}]\n{}\n", roff(section.name), roff(section.help));
    for (const Key& key : key_table())
      if (key.section == section.name)
        text +=
            fmt::format(".TP\n.B {}\n{} (default {}{})\n", roff(key.full_name()), roff(key.help),
                        roff(key.preset), key.allowed().empty() ? "" : "; " + roff(key.allowed()));
  }
  return text +
         ".SH EXIT STATUS\n0 done, 1 internal error, 2 bad input, 3 not converged, 4 a criterion "
         "failed, 130 interrupted.\n.SH ENVIRONMENT\n.TP\n.B XDG_CACHE_HOME\nresults are kept in "
         "its folder fingertip\n.SH SEE ALSO\n.BR fingertip (1)\n.I explain KEY\ntells more about "
         "a key, \n.I init\nwrites a configuration with all of them.\n";
}

std::string bash_completion() {
  std::string verbs, options, choices, keys, values;
  for (const VerbWords& verb : verb_words()) {
    verbs += (verbs.empty() ? "" : " ") + verb.name;
    std::vector<std::string> names;
    for (const VerbWords::Option& option : verb.options) {
      names.push_back(option.name);
      if (!option.choices.empty())
        choices += fmt::format("    {}:{}) words='{}' ;;\n", verb.name, option.name,
                               joined(option.choices));
    }
    options += fmt::format("    {}) words='{}' ;;\n", verb.name, joined(names));
  }
  for (const Key& key : key_table()) {
    keys += (keys.empty() ? "" : " ") + key.full_name() + "=";
    if (const std::vector<std::string> words = words_of(key); !words.empty())
      values += fmt::format("    {}) words='{}' ;;\n", key.full_name(), joined(words));
  }
  return fmt::format(R"(# bash completion for fingertip
_fingertip() {{
  local verb= words= key= word previous
  word=${{COMP_LINE:0:COMP_POINT}}
  word=${{word##*[[:space:]]}}
  previous=${{COMP_WORDS[COMP_CWORD - 1]}}
  [[ $previous == = || $word == *=* ]] && previous=--set
  local i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case " {0} " in *" ${{COMP_WORDS[i]}} "*) verb=${{COMP_WORDS[i]}}; break ;; esac
  done
  if [[ -z $verb ]]; then
    words='{0}'
  elif [[ $previous == --set && $word == *=* ]]; then
    key=${{word%%=*}}
    case $key in
{4}    esac
    COMPREPLY=($(compgen -W "$words" -- "${{word#*=}}"))
    return
  elif [[ $previous == --set ]]; then
    compopt -o nospace
    words='{3}'
  else
    case $verb:$previous in
{2}    esac
    if [[ -z $words && $word == -* ]]; then
      case $verb in
{1}      esac
    fi
  fi
  if [[ -z $words ]]; then
    compopt -o default
    return
  fi
  COMPREPLY=($(compgen -W "$words" -- "$word"))
}}
complete -F _fingertip fingertip
)",
                     verbs, options, choices, keys, values);
}

}  // namespace fingertip::studies::inline cli::inline command_line
