#ifndef SCREWLINE_ROS_BOUNDED_CACHE_H
#define SCREWLINE_ROS_BOUNDED_CACHE_H

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace screwline {
namespace ros_bridge {

/// What is costly to make and asked for again, by key; at most `bound` of them, then it starts anew. Thread-safe; a
/// value lives as long as somebody holds it.
template <typename Key, typename Value>
class BoundedCache {
 public:
  explicit BoundedCache(std::size_t bound) : bound_(bound) {}

  /// The value of the key; make() returns a Value where there is none yet. What it throws passes, and nothing is kept.
  template <typename Make>
  std::shared_ptr<const Value> get(const Key& key, Make&& make) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = values_.find(key);
    if (found != values_.end()) return found->second;
    auto value = std::make_shared<const Value>(make());
    if (values_.size() >= bound_) values_.clear();
    return values_.emplace(key, std::move(value)).first->second;
  }

 private:
  std::size_t bound_;
  std::mutex mutex_;
  std::map<Key, std::shared_ptr<const Value>> values_;
};

}  // namespace ros_bridge
}  // namespace screwline

#endif  // SCREWLINE_ROS_BOUNDED_CACHE_H
