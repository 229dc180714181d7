#pragma once
/// The versions a log, a bus and a build are compared by.

#include <cstdint>

namespace s4tp {

inline constexpr std::uint8_t kApiVersion = 6;         ///< planner.hpp and s4tp.h
inline constexpr std::uint8_t kWireVersion = 8;        ///< s4tp.dbc; checked against the DBC at build time
inline constexpr std::uint8_t kParametersVersion = 7;  ///< parameters.def
inline constexpr std::uint8_t kWeightsVersion = 2;     ///< weight_image.hpp

}  // namespace s4tp
