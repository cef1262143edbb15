#include "yaml_brackets.h"

#include <cctype>
#include <vector>

namespace screwline {
namespace {

/// Reads a text by characters; knows where a token may begin.
class Scan {
 public:
  explicit Scan(const std::string& text) : text_(text) {}

  std::optional<std::string> run() {
    for (; at_ < text_.size() && !problem_; ++at_) step(text_[at_]);
    if (!problem_ && !open_.empty()) report(std::string("'") + open_.back() + "' is not closed");
    return problem_;
  }

 private:
  void step(char c) {
    if (c == '\n') ++line_;
    if (c == '#' && (at_ == 0 || std::isspace(before(at_)) != 0)) {
      skipTo('\n');
    } else if ((c == '"' || c == '\'') && beginsToken()) {
      skipQuoted(c);
    } else if ((c == '[' || c == '{') && (!open_.empty() || beginsToken())) {
      open_.push_back(c);
    } else if ((c == ']' || c == '}') && (!open_.empty() || beginsToken())) {
      close(c);
    }
  }

  unsigned char before(std::size_t at) const { return static_cast<unsigned char>(text_[at - 1]); }

  bool beginsToken() const {
    std::size_t at = at_;
    while (at > 0 && (text_[at - 1] == ' ' || text_[at - 1] == '\t')) --at;
    return at == 0 || std::string("\n:-,[{?").find(text_[at - 1]) != std::string::npos;
  }

  void close(char c) {
    const char opening = c == ']' ? '[' : '{';
    if (open_.empty() || open_.back() != opening) {
      report(std::string("'") + c + "' closes no '" + opening + "'");
    } else {
      open_.pop_back();
    }
  }

  /// To just before the next `end`.
  void skipTo(char end) {
    while (at_ + 1 < text_.size() && text_[at_ + 1] != end) ++at_;
  }

  void skipQuoted(char quote) {
    for (++at_; at_ < text_.size() && text_[at_] != quote; ++at_) {
      if (text_[at_] == '\n') ++line_;
      if (quote == '"' && text_[at_] == '\\') ++at_;
    }
  }

  void report(const std::string& what) { problem_ = "line " + std::to_string(line_) + ": " + what; }

  const std::string& text_;
  std::size_t at_ = 0;
  int line_ = 1;
  std::vector<char> open_;
  std::optional<std::string> problem_;
};

}  // namespace

std::optional<std::string> wrongBrackets(const std::string& yaml) {
  return Scan(yaml).run();
}

}  // namespace screwline
