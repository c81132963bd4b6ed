// Arrays of bytes as arrays of NumPy.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>

namespace racebeam::python {

namespace nb = nanobind;

using Bytes = nb::ndarray<nb::numpy, std::uint8_t>;

// An array that the caller passes for results.
using Buffer = nb::ndarray<std::uint8_t, nb::c_contig, nb::device::cpu>;

// Memory that is filled without the GIL. An array then owns it.
class FreshBytes {
 public:
  FreshBytes() = default;
  explicit FreshBytes(std::size_t size) : memory_(new std::uint8_t[size]), size_(size) {}

  std::size_t size() const { return size_; }
  std::span<std::uint8_t> span() { return {memory_.get(), size_}; }

  Bytes array(std::initializer_list<std::size_t> shape) && {
    std::uint8_t* const data = memory_.release();
    const nb::capsule owner(data, [](void* bytes) noexcept { delete[] static_cast<std::uint8_t*>(bytes); });
    return Bytes(data, shape, owner);
  }

 private:
  std::unique_ptr<std::uint8_t[]> memory_;
  std::size_t size_ = 0;
};

}  // namespace racebeam::python
