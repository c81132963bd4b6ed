# Linux with the C library musl, as Alpine has it, on x86-64. Programs are static, so that they run here. platforms/setup
# installs what is needed.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(zig_processor x86_64)
set(zig_system linux-musl)
include(${CMAKE_CURRENT_LIST_DIR}/zig.cmake)
list(APPEND CMAKE_FIND_ROOT_PATH ${built}/musl)
set(CMAKE_CROSSCOMPILING_EMULATOR env)
add_compile_definitions(RACEBEAM_WITHOUT_AVX)
