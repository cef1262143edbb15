#ifndef SCREWLINE_ROS_PARAM_READER_H
#define SCREWLINE_ROS_PARAM_READER_H

#include <XmlRpcValue.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace screwline {
namespace ros_bridge {

/// Reads a node's private parameters out of one XmlRpc struct. Every method that reads takes the key's name without the
/// "~", and throws ModelError naming the key and the bound where type or value are wrong.
class ParamReader {
 public:
  /// A struct, or an invalid value where nothing is set. `prefix` stands before keys in messages.
  explicit ParamReader(const XmlRpc::XmlRpcValue& values, const std::string& prefix = "~");

  bool has(const std::string& key) const;
  /// The key as messages call it.
  std::string nameOf(const std::string& key) const { return prefix_ + key; }
  /// Allows a key that somebody else reads.
  void pass(const std::string& key);

  std::string text(const std::string& key, const std::string& otherwise);
  std::vector<std::string> texts(const std::string& key);
  bool flag(const std::string& key, bool otherwise);
  /// In (above, at_most].
  double number(const std::string& key, double otherwise, double above, double at_most);
  /// In [0, at_most].
  double numberFromZero(const std::string& key, double otherwise, double at_most);
  /// In [at_least, at_most].
  int integer(const std::string& key, int otherwise, int at_least, int at_most);

  /// @throws ModelError naming a key that nobody asked for.
  void refuseUnknown() const;

 private:
  /// The value of a key, or null.
  const XmlRpc::XmlRpcValue* find(const std::string& key);
  std::optional<double> givenNumber(const std::string& key);
  [[noreturn]] void refuse(const std::string& key, const std::string& what) const;

  std::string prefix_;
  XmlRpc::XmlRpcValue values_;
  XmlRpc::XmlRpcValue current_;
  std::set<std::string> known_;
};

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_PARAM_READER_H
