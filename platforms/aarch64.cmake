# Linux on AArch64, with the cross compiler of Debian. Programs run in qemu-user. platforms/setup installs what is needed.
include(${CMAKE_CURRENT_LIST_DIR}/cross.cmake)
set(root ${built}/aarch64)
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
list(APPEND CMAKE_FIND_ROOT_PATH ${root} /usr/aarch64-linux-gnu)
list(APPEND CMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES ${root}/usr/include ${root}/usr/include/aarch64-linux-gnu)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
foreach(kind EXE SHARED MODULE)  # libraries that are named by -l, and those that libraries load
  set(CMAKE_${kind}_LINKER_FLAGS_INIT
    "-L${root}/usr/lib/aarch64-linux-gnu -Wl,-rpath-link,${root}/usr/lib/aarch64-linux-gnu:${root}/lib/aarch64-linux-gnu")
endforeach()
set(Boost_NO_BOOST_CMAKE ON)  # the headers and the library are of different packages
unset(ZLIB_USE_STATIC_LIBS)   # as on this machine
set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
set(CPACK_SHLIBDEPS ${root}/shlibdeps)  # finds the libraries there
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static -L ${root})
