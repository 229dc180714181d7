# Cortex-M55 with MVE; QEMU board mps3-an547.
set(S4TP_TARGET m55)
set(S4TP_BOARD mps3_an547)
set(S4TP_CPU_FLAGS "-mcpu=cortex-m55 -mthumb -mfloat-abi=hard")
include(${CMAKE_CURRENT_LIST_DIR}/arm_bare_metal.cmake)
