# Identical bits everywhere need identical arithmetic: no contraction, no vectorisation, no errno, never fast-math.
set(S4TP_ARITHMETIC -ffp-contract=off -fno-tree-vectorize -fno-math-errno)
set(S4TP_WARNINGS -Wall -Wextra -Wpedantic $<$<BOOL:${PROJECT_IS_TOP_LEVEL}>:-Werror>)

# The same archive or program in every folder.
set(S4TP_NO_PATHS -ffile-prefix-map=${PROJECT_BINARY_DIR}/= -ffile-prefix-map=${PROJECT_SOURCE_DIR}/=)

# The core: C++17, no heap, no exceptions, no RTTI.
function(s4tp_core_target target)
  target_compile_features(${target} PUBLIC cxx_std_17)
  set_target_properties(${target} PROPERTIES CXX_STANDARD 17)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_compile_options(${target} PRIVATE
    ${S4TP_ARITHMETIC} ${S4TP_WARNINGS} -Wconversion -Wshadow -Wdouble-promotion
    -fno-exceptions -fno-rtti -fno-threadsafe-statics -ffunction-sections -fdata-sections -fstack-usage
    ${S4TP_NO_PATHS})
endfunction()

# Eigen's headers, for the core's own sources: who builds the library needs them, who installs or links it does not. One
# order of additions on every target, and nothing of a heap, not even dead code that names it.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
function(s4tp_use_eigen target)
  target_include_directories(${target} SYSTEM PRIVATE $<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>)
  target_compile_definitions(${target} PRIVATE
    EIGEN_DONT_VECTORIZE EIGEN_MAX_ALIGN_BYTES=0 EIGEN_NO_MALLOC EIGEN_GEMM_TO_COEFFBASED_THRESHOLD=64 EIGEN_NO_IO)
endfunction()

# A precompiled header only saves time: where the compiler cannot read one, it reads the headers.
set(CMAKE_PCH_WARN_INVALID OFF)

# The host side and tests: C++20, ordinary C++; of debug information only what a backtrace needs, as more of it would
# double the time to build.
function(s4tp_host_target target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_STANDARD 20)
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR})
  target_compile_options(${target} PRIVATE ${S4TP_ARITHMETIC} ${S4TP_WARNINGS} -Wshadow -g1 ${S4TP_NO_PATHS})
endfunction()

# Sources compiled eight at a time, a quarter of the work where headers are most of it. ALONE: those that name something
# in their anonymous namespace as another one does.
function(s4tp_compile_together target)
  cmake_parse_arguments(PARSE_ARGV 1 together "" "" ALONE)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
  set_source_files_properties(${together_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
