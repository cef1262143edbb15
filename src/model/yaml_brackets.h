#ifndef SCREWLINE_SRC_MODEL_YAML_BRACKETS_H
#define SCREWLINE_SRC_MODEL_YAML_BRACKETS_H

#include <optional>
#include <string>

namespace screwline {

/// What is wrong with the brackets of flow collections in a YAML text, as "line 5: ']' closes no '['", or nothing.
/// yaml-cpp 0.6.3 takes memory without end where a bracket of the wrong kind closes a collection: such texts must not
/// reach it. Brackets in quotes, comments and inside of words are no brackets.
std::optional<std::string> wrongBrackets(const std::string& yaml);

}  // namespace screwline

#endif  // SCREWLINE_SRC_MODEL_YAML_BRACKETS_H
