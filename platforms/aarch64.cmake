# Linux on AArch64, with the cross compiler of Debian. Programs run in qemu-user. platforms/setup installs what is needed.
include(${CMAKE_CURRENT_LIST_DIR}/cross.cmake)
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
list(APPEND CMAKE_FIND_ROOT_PATH ${built}/aarch64 /usr/aarch64-linux-gnu)
list(APPEND CMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES ${built}/aarch64/usr/include)  # of its Python
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static -L /usr/aarch64-linux-gnu)
