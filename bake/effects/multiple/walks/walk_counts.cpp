#include "bake/effects/multiple/walks/walk_counts.h"

#include <algorithm>

namespace opaline::bake {

WalkEnds& WalkEnds::operator+=(const WalkEnds& other) {
    for (std::size_t b = 0; b < 3; ++b) {
        left[b] += other.left[b];
        met[b] += other.met[b];
        absorbed[b] += other.absorbed[b];
        unfinished[b] += other.unfinished[b];
    }
    return *this;
}

double WalkCounts::unfinished() const {
    double sum = 0;
    int bands = 0;
    for (std::size_t b = 0; b < 3; ++b) {
        sum += ends.unfinished[b] + straight.unfinished[b];
        bands += ends.all(b) + straight.all(b) > 0 ? 1 : 0;
    }
    return sum / std::max(1, bands);
}

double WalkCounts::scale(std::size_t band, bool fills_crossed) const {
    const auto all = static_cast<double>(walks);
    const double own = scattered[band];
    const bool is_replaced = straight.unfinished[band] + ends.unfinished[band] < 0.5 * all;
    const auto sum_of = [&](const WalkEnds& of) {
        return is_replaced ? of.finished(band) : of.all(band);
    };
    const double ended = sum_of(ends), other = sum_of(straight);
    if (!(ended > 0)) return 1;
    double share = (own + (fills_crossed ? straight.left[band] : 0)) / (own + other);
    if (own < other && !fills_crossed) {
        // Of a thin body what scatters is known far better than what does not.
        share = own / (is_replaced ? all - straight.unfinished[band] : all);
    }
    return all * share / ended;
}

double WalkCounts::scattered_share(std::size_t band) const {
    const double all = scattered[band] + straight.all(band) - filled[band];
    return all > 0 ? scattered[band] / all : 0;
}

WalkCounts& WalkCounts::operator+=(const WalkCounts& other) {
    walks += other.walks;
    events += other.events;
    rays += other.rays;
    jumps += other.jumps;
    searches += other.searches;
    lost += other.lost;
    endless += other.endless;
    buried += other.buried;
    ends += other.ends;
    straight += other.straight;
    for (std::size_t b = 0; b < 3; ++b) {
        scattered[b] += other.scattered[b];
        filled[b] += other.filled[b];
    }
    return *this;
}

}  // namespace opaline::bake
