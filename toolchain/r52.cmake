# Cortex-R52; no QEMU machine has one, so its images run in user mode with semihosting.
set(S4TP_TARGET r52)
set(S4TP_BOARD user_mode)
set(S4TP_CPU_FLAGS "-mcpu=cortex-r52 -mthumb -mfloat-abi=hard")
include(${CMAKE_CURRENT_LIST_DIR}/arm_bare_metal.cmake)
