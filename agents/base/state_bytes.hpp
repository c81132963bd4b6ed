// The state of an agent as bytes, for checkpoints. Checkpoints are read by the version that wrote them.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "system/invalid_input.hpp"

namespace racebeam {

class StateWriter {
 public:
  template <typename T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }

  template <typename T, typename Allocator>
  void put(const std::vector<T, Allocator>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    put(std::uint64_t{values.size()});
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }

  void put(std::string_view text) {
    put(std::uint64_t{text.size()});
    bytes_.append(text);
  }
  void put(const std::string& text) { put(std::string_view(text)); }

  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

// Reads what a StateWriter put, in the same order. Throws InvalidInput when the bytes end too early.
class StateReader {
 public:
  explicit StateReader(std::string_view bytes) : left_(bytes) {}

  template <typename T>
  void get(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
  }

  template <typename T, typename Allocator>
  void get(std::vector<T, Allocator>& values) {
    const std::string_view bytes = take_counted(sizeof(T));
    values.resize(bytes.size() / sizeof(T));
    if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  }

  void get(std::string& text) { text = take_counted(1); }

  bool at_end() const { return left_.empty(); }

 private:
  std::string_view take(std::uint64_t size) {
    if (size > left_.size()) refuse();
    const std::string_view part = left_.substr(0, size);
    left_.remove_prefix(size);
    return part;
  }

  std::string_view take_counted(std::size_t each) {
    std::uint64_t count = 0;
    get(count);
    if (count > left_.size() / each) refuse();
    return take(count * each);
  }

  [[noreturn]] static void refuse() { throw InvalidInput("it ends too early"); }

  std::string_view left_;
};

}  // namespace racebeam
