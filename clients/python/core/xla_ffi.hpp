// The part of XLA's C interface for custom calls ("XLA FFI", xla/ffi/api/c_api.h of OpenXLA) that
// bind_xla.cpp needs. It is declared here, so that building the package does not need JAX. The interface is
// stable: each structure begins with its size, and newer versions only append members.
// tests/python/test_xla.py compares this file with JAX's header.
#pragma once

#include <cstddef>
#include <cstdint>

namespace racebeam::python::xla {

struct Error;  // defined by XLA

enum class ErrorCode : int {
  kInvalidArgument = 3,
  kFailedPrecondition = 9,
  kOutOfRange = 11,
  kInternal = 13
};
enum class DataType : int { kBool = 1, kInt32 = 4, kUint8 = 6, kFloat32 = 11 };

struct Extension {
  std::size_t struct_size;
  int type;
  Extension* next;
};
inline constexpr int kMetadataExtension = 1;

struct ApiVersion {
  std::size_t struct_size;
  Extension* extensions;
  int major_version;
  int minor_version;
};
inline constexpr int kMajorVersion = 0;
inline constexpr int kMinorVersion = 3;  // the newest version that this file was compared with

// XLA asks a handler for its version by a call with this extension.
struct Metadata {
  std::size_t struct_size;
  ApiVersion api_version;
  std::uint32_t traits;
};

struct MetadataExtension {
  Extension base;
  Metadata* metadata;
};

struct ErrorCreateArgs {
  std::size_t struct_size;
  Extension* extensions;
  const char* message;
  ErrorCode code;
};

struct Api {
  std::size_t struct_size;
  Extension* extensions;
  ApiVersion api_version;
  const void* internal_api;
  Error* (*error_create)(ErrorCreateArgs* arguments);
};

struct Buffer {
  std::size_t struct_size;
  Extension* extensions;
  DataType type;
  void* data;
  std::int64_t rank;
  std::int64_t* shape;
};

// The arguments of a call, or its results.
struct Buffers {
  std::size_t struct_size;
  Extension* extensions;
  std::int64_t size;
  int* kinds;  // 1: a buffer, the only kind so far
  void** buffers;
};

struct CallFrame {
  std::size_t struct_size;
  Extension* extensions;
  const Api* api;
  void* context;
  int stage;
  Buffers arguments;
  Buffers results;
};

using Handler = Error*(CallFrame*);

}  // namespace racebeam::python::xla
