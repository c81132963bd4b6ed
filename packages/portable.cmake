# How everything is built for other systems than this one. A Python module loads nothing but the C library and
# the compiler's libgcc_s, which each Linux has; and no symbol is seen by other modules of the process. With
# RACEBEAM_STATIC the program loads nothing at all.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
if(NOT APPLE)
  add_link_options(-static-libstdc++ -Wl,--as-needed -Wl,--gc-sections)
endif()
add_compile_options(-ffunction-sections -fdata-sections)

set(BUILD_TESTING OFF)
if(RACEBEAM_STATIC)
  string(APPEND CMAKE_EXE_LINKER_FLAGS " -static")
  if(CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
    string(APPEND CMAKE_EXE_LINKER_FLAGS " -fno-lto")  # g++ 12 has an internal error (add_symbol_to_partition_1)
  endif()
  set(ZLIB_USE_STATIC_LIBS ON)
endif()
set(Boost_USE_STATIC_LIBS ON)
set(OPENSSL_USE_STATIC_LIBS ON)
find_library(PNG_LIBRARY NAMES libpng.a png)
# Libraries that are headers if told so.
add_compile_definitions(TOML_HEADER_ONLY=1 FMT_HEADER_ONLY=1)
set(RACEBEAM_SPDLOG spdlog::spdlog_header_only)
set(RACEBEAM_TOML "")
