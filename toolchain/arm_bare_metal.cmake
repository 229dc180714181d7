# Bare-metal Arm: what the targets m7, m55 and r52 share. Set S4TP_TARGET and S4TP_CPU_FLAGS, then include this.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)

set(S4TP_BARE_METAL ON)
set(CMAKE_C_FLAGS_INIT "${S4TP_CPU_FLAGS}")
set(CMAKE_CXX_FLAGS_INIT "${S4TP_CPU_FLAGS}")

# libc gives memcpy and its kind only: malloc would need _sbrk, which nobody defines, so it cannot link.
# libgcc's 64-bit division names the unwinder's personality; at address 0 it brings no unwinder in.
set(CMAKE_EXE_LINKER_FLAGS_INIT
  "-nostartfiles -nodefaultlibs -Wl,--gc-sections -Wl,--defsym=__aeabi_unwind_cpp_pr0=0 -Wl,--fatal-warnings \
-L${CMAKE_CURRENT_LIST_DIR}/linker -T${CMAKE_CURRENT_LIST_DIR}/linker/${S4TP_TARGET}.ld")
set(CMAKE_CXX_STANDARD_LIBRARIES_INIT "-lc -lgcc")
