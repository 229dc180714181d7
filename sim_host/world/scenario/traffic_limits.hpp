#pragma once
/// How much traffic a file may ask for.

#include <cstddef>

namespace s4tp::scenario {

/// FILE-003 Cars that a file may let in, at most, and until when they are counted: the longest episode, with
/// something to spare. Every one is drawn before the episode begins.
inline constexpr double kCarsMax = 200'000.0;
inline constexpr double kCarsCounted_s = 4'800.0;

/// FILE-002 What distributions of a route file come to, at most: equal routes are one, with their weights
/// added, as distributions of distributions grow fast.
inline constexpr std::size_t kChoicesMax = 1'000'000;  ///< routes and drivers to choose from, of all flows
inline constexpr std::size_t kChoiceMax = 10'000;      ///< routes of one distribution
inline constexpr std::size_t kDriversMax = 1'000;      ///< kinds of drivers of one distribution
inline constexpr double kWeightMax = 1e12;             ///< of one route
inline constexpr std::size_t kGuidedMax = 2'000'000;   ///< lanes along all different routes, each counted

}  // namespace s4tp::scenario
