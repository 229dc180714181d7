# 64-bit Arm Linux, linked statically, run with qemu-aarch64.
set(S4TP_TARGET aarch64)
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
# Atomics in place instead of in a library that asks the kernel at start.
set(CMAKE_CXX_FLAGS_INIT -mno-outline-atomics)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_EXE_LINKER_FLAGS_INIT "-static")
