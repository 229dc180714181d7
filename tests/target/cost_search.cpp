#include "tests/target/cost_search.hpp"

namespace s4tp::test {
namespace {

constexpr std::uint32_t kRandomFirst = 60;  // before anything is worth changing
constexpr std::uint32_t kStrangers = 20;    // one in so many is made of nothing else
/// Whose elites are changed, row by row: those that can be dear more often.
constexpr int kTurns[] = {8, 8, 8, 4, 3, 0, 0, 1, 1, 2, 5, 6, 6, 9, 10, 11, 12, 13, 14, 15, 16, 17, 17};

}  // namespace

std::uint32_t CostSearch::below(std::uint32_t bound) {
  random_ ^= random_ << 13U;
  random_ ^= random_ >> 17U;
  random_ ^= random_ << 5U;
  return (random_ >> 8U) % bound;
}

const Genome& CostSearch::parent() {
  const int row = kTurns[below(sizeof kTurns / sizeof kTurns[0])];
  // Of two the dearer: the dearest most often.
  const std::uint32_t a = below(kElites);
  const std::uint32_t b = below(kElites);
  return elites_[row][a < b ? a : b].genome;
}

void CostSearch::mutate(Genome& genome) {
  constexpr int kTracksBegin = kMapGenes + kEgoGenes;
  const auto track = [&](std::uint32_t i) { return genome.genes + kTracksBegin + i * kTrackGenes; };
  for (std::uint32_t changes = 1 + below(4); changes > 0; --changes) {
    switch (below(6)) {
      case 0:
        genome.genes[below(kGenes)] = static_cast<std::uint8_t>(below(256));
        break;
      case 1: {
        std::uint8_t& gene = genome.genes[below(kTracksBegin)];
        gene = static_cast<std::uint8_t>(gene + below(17) - 8);
        break;
      }
      case 2:
      case 3: {
        std::uint8_t& gene = genome.genes[below(kGenes)];
        gene = static_cast<std::uint8_t>(gene + below(33) - 16);
        break;
      }
      case 4: {  // one vehicle becomes nearly another
        const std::uint8_t* const from = track(below(kMaxTracks));
        std::uint8_t* const to = track(below(kMaxTracks));
        for (int i = 0; i < kTrackGenes; ++i) to[i] = from[i];
        to[2 + below(3)] = static_cast<std::uint8_t>(to[2] + below(41) - 20);
        break;
      }
      default: {
        const Genome& other = parent();
        const bool map = below(4) == 0;
        const std::uint32_t begin = map ? 0 : kTracksBegin + below(kMaxTracks) * kTrackGenes;
        const std::uint32_t end = map ? kMapGenes : kGenes;
        for (std::uint32_t i = begin; i < end; ++i) genome.genes[i] = other.genes[i];
      }
    }
  }
}

Genome CostSearch::propose() {
  Genome genome;
  if (taken_ < kRandomFirst || below(kStrangers) == 0) {
    for (std::uint8_t& gene : genome.genes) gene = static_cast<std::uint8_t>(below(256));
    return genome;
  }
  genome = parent();
  mutate(genome);
  return genome;
}

void CostSearch::take(const Genome& genome, const Cost& cost) {
  ++taken_;
  for (int row = 0; row < kCostRows; ++row) {
    Elite(&elites)[kElites] = elites_[row];
    const std::uint32_t count = cost.rows[row];
    bool known = false;
    for (const Elite& elite : elites) known = known || elite.count == count;
    if (known || count < elites[kElites - 1].count) continue;
    int place = kElites - 1;
    for (; place > 0 && elites[place - 1].count < count; --place) elites[place] = elites[place - 1];
    elites[place] = {genome, count};
  }
}

}  // namespace s4tp::test
