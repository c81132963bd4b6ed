# How everything is built for a Python package. Nothing is linked at run time but the C library, the compiler's libgcc_s
# and zlib, which each Linux has; and no symbol is seen by other modules of the process.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
add_link_options(-static-libstdc++ -Wl,--as-needed -Wl,--gc-sections)
add_compile_options(-ffunction-sections -fdata-sections)

set(BUILD_TESTING OFF)
set(Boost_USE_STATIC_LIBS ON)
set(OPENSSL_USE_STATIC_LIBS ON)
find_library(PNG_LIBRARY NAMES libpng.a png)
# Libraries that are headers if told so.
add_compile_definitions(TOML_HEADER_ONLY=1 FMT_HEADER_ONLY=1)
set(RACEBEAM_SPDLOG spdlog::spdlog_header_only)
set(RACEBEAM_TOML "")
