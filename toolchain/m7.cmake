# Cortex-M7 with a single-precision FPU; QEMU board mps2-an500.
set(S4TP_TARGET m7)
set(S4TP_BOARD mps2_an500)
set(S4TP_CPU_FLAGS "-mcpu=cortex-m7 -mthumb -mfloat-abi=hard -mfpu=fpv5-sp-d16")
include(${CMAKE_CURRENT_LIST_DIR}/arm_bare_metal.cmake)
