# macOS from 11 on, with Zig, whose package has Clang, a linker, and the headers and symbols of the system. Its C++ library is
# linked into each program. No program for macOS runs here. platforms/setup installs what is needed.
include(${CMAKE_CURRENT_LIST_DIR}/cross.cmake)
set(CMAKE_SYSTEM_NAME Darwin)
set(CMAKE_CXX_COMPILER ${built}/zig/c++)
set(CMAKE_CXX_COMPILER_TARGET ${zig_processor}-macos.11.0)
set(CMAKE_AR ${built}/zig/ar CACHE FILEPATH "")
set(CMAKE_RANLIB ${built}/zig/ranlib CACHE FILEPATH "")
set(CMAKE_INSTALL_NAME_TOOL true)  # no installed file has a path that it would change
set(CMAKE_SKIP_RPATH ON)
set(CMAKE_OSX_SYSROOT "")
list(APPEND CMAKE_FIND_ROOT_PATH ${built}/${platform})
