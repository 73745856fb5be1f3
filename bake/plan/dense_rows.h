#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "bake/receivers/receiver.h"

namespace opaline::bake {

struct Prepared;

/// T_k of one receiver before selection: term by term, band by band, Haar coefficients of a cube
/// map (formats/opal/haar.h). Effects add to it.
struct DenseRow {
    std::span<float> values;  ///< terms * bands * 6 n n
    std::uint32_t cubemap_size = 0, terms = 1, bands = 1;

    std::size_t size() const { return values.size() / (std::size_t{terms} * bands); }
    /// One band of one term: 6 n n values.
    std::span<float> plane(std::uint32_t term, std::uint32_t band) const {
        return values.subspan((std::size_t{term} * bands + band) * size(), size());
    }
};

/// Where it gathers.
struct GatherReceiver {
    const Receiver& outside;
    const BodyPoint& inside;
    const Prepared* batch = nullptr;  ///< where the effect gathers in batches: the receiver's
    std::size_t place = 0;            ///< in that batch
};

/// Where the truth is asked for.
struct TruthReceiver {
    const Receiver& outside;
    const BodyPoint& inside;
    std::uint32_t key = 0;  ///< of its random numbers: the receiver's running number
    bool behind = false;    ///< seen from behind: of thin-walled surfaces alone
    /// Of media: unit, inside, toward the eye; 0: along the normal, or, where rows are the same for
    /// all views, the mean over these.
    glm::vec3 seen{0};
};

}  // namespace opaline::bake
