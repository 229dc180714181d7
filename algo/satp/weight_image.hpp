#pragma once
/// The network's numbers as they lie in flash: a header, then the layers in the order of network_shape.hpp.
///
/// \code
///   | WeightHeader | layer 0: bias, multiplier, weights | layer 1 ... |   little endian, all 4-byte aligned
/// \endcode
/// An image is looked at once, at start: what passes can be computed with, whatever the input, without any
/// accumulator running over.

#include <cstdint>

#include "algo/satp/network_shape.hpp"

namespace s4tp::satp {

inline constexpr std::uint32_t kWeightMagic = 0x50544153U;  ///< "SATP"
inline constexpr std::uint32_t kWeightFormat = 2;  ///< changes with this header, the table or an equation

/// 80 bytes; every field is a word.
struct WeightHeader {
  std::uint32_t magic;
  std::uint32_t format;
  std::uint32_t shape_id;
  std::uint32_t width, heads, feed_forward, hidden, embed, modes, lane_points, decoder_steps,
      steps_per_decode;
  std::uint32_t payload_bytes;
  float temperature;       ///< of the modes' probabilities; 0.05 .. 20
  float usual_residual_m;  ///< how far the likeliest future is off after 0.5 s, 95 % of the training's scenes
  std::uint32_t trained_steps;  ///< for people
  std::uint32_t seed;           ///< for people
  std::uint32_t reserved;
  std::uint32_t payload_crc;  ///< CRC-32 of all that follows the header
  std::uint32_t header_crc;   ///< CRC-32 of all before this field
};
static_assert(sizeof(WeightHeader) == 80, "no padding: it is what lies in flash");

enum class WeightStatus : std::uint8_t {
  kOk,
  kAbsent,      ///< no image given
  kTruncated,   ///< shorter than it says, or than a header
  kNotWeights,  ///< no magic word, or not aligned to 4 bytes
  kFormat,      ///< of another version of this format
  kShape,       ///< of another size of network
  kChecksum,    ///< header or payload is not what was written
  kRange,       ///< a number outside its range: an accumulator could run over
};

/// \return the enumerator's name, for logs
[[nodiscard]] const char* weight_status_name(WeightStatus status);

/// y = requantize(bias + W x), see requantize.hpp.
struct Linear {
  const std::int8_t* weights;      ///< [rows][stride]
  const std::int32_t* bias;        ///< [bias_rows][rows]
  const std::int32_t* multiplier;  ///< [rows]; bits of floats where the output is kReal
  std::int16_t rows;
  std::int16_t columns;
  std::int16_t stride;
};

struct Norm {
  const std::int32_t* bias;
  const std::int32_t* gain;
};

/// A checked image; points into it.
class Weights {
 public:
  /// SATP-010 Anything but a whole, unharmed image of the deployed size is refused, with the reason;
  /// `weights` is then as before. SATP-011 In what is accepted no accumulator can leave its range. \param
  /// image  must stay while the weights are used \param size_bytes  at least the image's \note reads the
  /// whole image: some ten million instructions, at start only
  [[nodiscard]] static WeightStatus check(const void* image, std::uint32_t size_bytes, Weights& weights);

  [[nodiscard]] bool present() const { return payload_ != nullptr; }
  [[nodiscard]] const WeightHeader& header() const { return *header_; }  ///< \pre present()
  /// \pre present(), and the layer is of that kind
  [[nodiscard]] Linear linear(int layer) const;
  [[nodiscard]] Norm norm(int layer) const;
  [[nodiscard]] const std::int32_t* words(int layer) const;  ///< of the other kinds

 private:
  const WeightHeader* header_ = nullptr;
  const std::int32_t* payload_ = nullptr;
};

/// Bytes of a whole image of the deployed size.
inline constexpr int kImageBytes = static_cast<int>(sizeof(WeightHeader)) + payload_bytes(kMcuShape);
static_assert(kImageBytes <= kWeightBudgetBytes, "the weights have outgrown their bank");

/// Header of an image of `shape`, without checksums. \see seal
[[nodiscard]] WeightHeader header_of(const NetworkShape& shape);
/// Writes both checksums into the header an image begins with. \param image  header and payload, one behind
/// the other
void seal(void* image);

}  // namespace s4tp::satp
