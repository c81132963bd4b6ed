# What toolchains of this folder share: libraries are those of the platform, and programs those of this machine.
# platforms/setup links libraries that are only headers into build/platforms/headers.
get_filename_component(built ${CMAKE_CURRENT_LIST_DIR}/../build/platforms ABSOLUTE)
set(CMAKE_FIND_ROOT_PATH ${built}/headers)
set(CMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES ${built}/headers/include)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ZLIB_USE_STATIC_LIBS ON)
