# macOS from 11 on. No program for macOS runs here. platforms/setup installs what is needed.
set(CMAKE_SYSTEM_NAME Darwin)
set(zig_system macos.11.0)
include(${CMAKE_CURRENT_LIST_DIR}/zig.cmake)
set(CMAKE_INSTALL_NAME_TOOL true)  # no installed file has a path that it would change
set(CMAKE_SKIP_RPATH ON)
set(CMAKE_OSX_SYSROOT "")
list(PREPEND CMAKE_FIND_ROOT_PATH ${built}/${platform})
list(PREPEND CMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES ${built}/${platform}/include)  # Boost is newer than that of Debian
list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR}/find)
set(OPENSSL_USE_STATIC_LIBS ON)
set(Boost_USE_STATIC_LIBS ON)
set(Boost_NO_WARN_NEW_VERSIONS ON)
