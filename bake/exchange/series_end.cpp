#include "bake/exchange/series_end.h"

#include <algorithm>

namespace opaline::bake {

void SeriesEnd::add(std::span<const double> sums) {
    ++count_;
    before_ = last_;
    for (std::size_t b = 0; b < sums.size(); ++b) {
        last_[b] = sums[b] - all_[b];
        all_[b] = sums[b];
        emitted_[b] = count_ == 1 ? sums[b] : emitted_[b];
    }
}

double SeriesEnd::ratio(std::size_t band) const {
    return before_[band] > 0 ? std::clamp(last_[band] / before_[band], 0.0, kLargestRatio) : 0;
}

double SeriesEnd::remaining() const {
    double most = 0;
    for (std::size_t b = 0; b < all_.size(); ++b) {
        if (!(all_[b] > 0)) continue;
        if (count_ < 2) return 1;
        const double next = ratio(b) * last_[b], later = rest(b) * next;
        most = std::max(most, later / (all_[b] + next + later));
    }
    return most;
}

bool SeriesEnd::is_settled(double least) const {
    for (std::size_t b = 0; b < all_.size(); ++b) {
        if (ratio(b) * last_[b] > least * emitted_[b]) return false;
    }
    return remaining() <= least;
}

}  // namespace opaline::bake
