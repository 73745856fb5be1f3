#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/emitters/media_patches.h"
#include "bake/lamps/lamp_sources.h"
#include "bake/lamps/media_light.h"
#include "bake/lamps/receiver_light.h"
#include "bake/transport/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Whether most of a lamp's power starts inside of media that scatter: of the rays from where it
/// starts, in all directions, most meet the back of such a medium's surface first. Such light goes
/// nowhere in a bake.
bool is_immersed(const formats::Scene& scene, const RayScene& rays, const LampSources& lamp);

/// Watches light of media change from pass to pass, B_i+1 - B_i ~ q^i, and ends the series.
class SeriesSum {
  public:
    /// Passes end once all lamps' light changes by less than `least` of itself.
    SeriesSum(std::size_t lamps, double least) : lamps_(lamps), least_(least) {}

    /// Whether `after` needs no further pass, or gets none. Then the sum of all changes to come is
    /// added to it, q that of the last two passes, lamp by lamp and band by band.
    bool is_last(const MediaLight& before, MediaLight& after, bool gets_none);

  private:
    std::size_t lamps_;
    double least_;
    std::vector<glm::dvec3> last_;  // change of the pass before, summed up, by lamp
};

/// What media are lit from.
struct MediaJob {
    const LitMedia& media;
    std::span<const ReceiverSet> receivers;                ///< by primitive
    std::span<const formats::PrimitiveRecord> primitives;  ///< of the file
    std::uint32_t particles = 0;                           ///< of each lamp, at least 1
};

/// Rows of lamps' light on media: [primitive][lamp][row], outgoing radiance [nit] as `T_k` holds
/// it; nothing of other primitives.
using MediaRows = std::vector<std::vector<std::vector<formats::Rgb>>>;

/// Solves for the light of lamps that media scatter, with the exchange between media and other
/// surfaces. `light` comes without media; the light that media send to surfaces is added to its
/// irradiance, and `exitance` is the light that leaves them.
///
/// B = M (E_0 + K B) over media, M the response of the media, K transport from medium to medium,
/// straight or by other surfaces (particles). M is measured once at coarse settings, patch by
/// patch. Passes start at B = 0 and end when one changes B by less than a hundredth. The remaining
/// sum is extrapolated from the ratio of the last two, lamp by lamp and band by band. One more
/// application of M gives the rows.
MediaRows light_media(const MediaJob& job, const LampLight& light, std::span<ElementLight> elements,
                      MediaLight& exitance, const Context& context, std::uint64_t& rays);

/// The smallest basis that has a column for each lamp: n of 6 n n, a power of two.
std::uint32_t lamp_basis(std::size_t lamps);

}  // namespace opaline::bake
