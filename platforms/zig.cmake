# With Zig, whose package has Clang, a linker, and the headers and libraries of several systems. Its C++ library is linked into
# each program. The processor is zig_processor, and the system zig_system.
include(${CMAKE_CURRENT_LIST_DIR}/cross.cmake)
set(CMAKE_CXX_COMPILER ${built}/zig/c++)
set(CMAKE_CXX_COMPILER_TARGET ${zig_processor}-${zig_system})
set(CMAKE_AR ${built}/zig/ar CACHE FILEPATH "")
set(CMAKE_RANLIB ${built}/zig/ranlib CACHE FILEPATH "")
