#pragma once
/// Elementwise arithmetic of the network, for whatever processor this is: the functions of lanes_plain.hpp.
///
/// SATP-027 Every one gives the bits of its plain counterpart, on every target. Internal: for algo/satp's
/// own sources. \pre counts are multiples of 8; rows do not overlap but where they are the same

#include "algo/satp/lanes_plain.hpp"

#if defined(__ARM_FEATURE_MVE) && (__ARM_FEATURE_MVE & 1)
#include "algo/satp/lanes_mve.hpp"
namespace s4tp::satp {
namespace lanes = mve;
}
#elif defined(__ARM_FEATURE_DSP) && defined(__thumb__)
#include "algo/satp/lanes_dsp.hpp"
namespace s4tp::satp {
namespace lanes = dsp;
}
#else
namespace s4tp::satp {
namespace lanes = plain;
}
#endif
