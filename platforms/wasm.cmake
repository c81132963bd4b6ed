# WebAssembly, with the compiler Emscripten of Debian. Programs run in Node. platforms/setup installs what is needed.
include(${CMAKE_CURRENT_LIST_DIR}/cross.cmake)
include(/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)
list(APPEND CMAKE_FIND_ROOT_PATH ${built}/headers ${built}/wasm)
set(CMAKE_CROSSCOMPILING_EMULATOR node --no-experimental-fetch)  # with fetch(), a program does not find its code
set(CMAKE_CXX_FLAGS_INIT "-fwasm-exceptions -include ${CMAKE_CURRENT_LIST_DIR}/wasm/cxx20.hpp -DBOOST_ASIO_HAS_STD_INVOKE_RESULT")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-sALLOW_MEMORY_GROWTH=1 -sNODERAWFS=1 --pre-js ${CMAKE_CURRENT_LIST_DIR}/wasm/environment.js")
