#include "bake/effects/multiple/walks/ball_bank.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "bake/base/frame.h"
#include "bake/base/ordered_parallel.h"
#include "bake/effects/multiple/walks/walk.h"
#include "bake/physics/phase.h"

namespace opaline::bake {
namespace {

constexpr float kLeastBankRadius = 1.5f;
constexpr double kStepsPerOctave = 3;

// [mean free paths]. Scatterings, about the square of a radius, are whole numbers in 24 bits.
constexpr double kLargest = 2048;

// Starts of walks that belong to no site: a bank has 256 radii at most.
constexpr std::uint32_t kFirstStart = 0xffff0000u;

// Scatterings are a Poisson process along a long way. Sums of those of few records, drawn again and
// again, would drift away from it.
float draw_scatterings(float length, WalkRandom& random) {
    const float radius = std::sqrt(-2 * std::log(1 - random.next()));
    const float normal = radius * std::cos(2 * std::numbers::pi_v<float> * random.next());
    return std::max(1.0f, std::round(length + std::sqrt(length) * normal));
}

}  // namespace

BallJump BallBank::draw(float clearance, glm::vec3 direction, float u, float v) const {
    const float place =
        static_cast<float>(kStepsPerOctave) * std::log2(clearance / kLeastBankRadius);
    auto k = std::min(static_cast<std::size_t>(std::max(0.0f, place)), radius_.size() - 1);
    if (k > 0 && radius_[k] > clearance) {
        --k;  // rounding
    }
    const auto i = static_cast<std::size_t>(u * static_cast<float>(kRecords));
    const Record& record = record_[k * kRecords + i];
    const float azimuth = 2 * std::numbers::pi_v<float> * v;
    const Frame frame = make_frame(direction);
    const float cosine = std::cos(azimuth), sine = std::sin(azimuth);
    const glm::vec3 toward = cosine * frame.u + sine * frame.v;
    const glm::vec3 beside = cosine * frame.v - sine * frame.u;
    const float across = std::sqrt(std::max(0.0f, 1 - record.along * record.along));
    BallJump jump;
    jump.way = radius_[k] * (record.along * direction + across * toward);
    jump.direction = glm::normalize(record.direction.x * toward + record.direction.y * beside +
                                    record.direction.z * direction);
    jump.length = record.length;
    jump.scatterings = record.scatterings;
    return jump;
}

BallBank make_ball_bank(const PhaseTable& phase, const BallBankOptions& options,
                        const Context& context) {
    using Record = BallBank::Record;
    struct Part {
        std::vector<Record> record;
        double events = 0;
    };
    BallBank bank;
    const auto walk = [&](float radius, bool jumps, WalkRandom& random, double& events) {
        glm::vec3 position(0), direction(0, 0, 1);
        Record record;
        for (;;) {
            ++events;
            const float clearance = radius - glm::length(position);
            if (jumps && clearance >= kLeastBankRadius) {
                const float u = random.next();
                const BallJump jump = bank.draw(clearance, direction, u, random.next());
                position += jump.way;
                direction = jump.direction;
                record.length += jump.length;
                record.scatterings += jump.scatterings;
                continue;
            }
            const float flight = -std::log(1 - random.next());
            const float b = glm::dot(position, direction);
            const float inside = std::max(0.0f, radius * radius - glm::dot(position, position));
            const float to_surface = std::sqrt(b * b + inside) - b;
            if (flight >= to_surface) {
                position += to_surface * direction;
                record.length += to_surface;
                break;
            }
            position += flight * direction;
            record.length += flight;
            ++record.scatterings;
            const float u = random.next();
            direction = scatter(phase, direction, u, random.next());
        }
        if (jumps && record.scatterings > 0) {
            record.scatterings = draw_scatterings(record.length, random);
        }
        const glm::vec3 place = glm::normalize(position);
        record.along = std::clamp(place.z, -1.0f, 1.0f);
        const float across = std::hypot(place.x, place.y);
        const glm::vec2 toward = across > 0 ? glm::vec2(place) / across : glm::vec2(1, 0);
        record.direction = {toward.x * direction.x + toward.y * direction.y,
                            toward.x * direction.y - toward.y * direction.x, direction.z};
        return record;
    };
    double events = 0, jumping = 0, of_next = 2.0 * BallBank::kRecords;
    for (std::uint32_t k = 0; k < 256 && !context.cancelled(); ++k) {
        const auto radius =
            static_cast<float>(double{kLeastBankRadius} * std::exp2(k / kStepsPerOctave));
        const bool jumps = events + of_next > options.events;
        if (double{radius} > std::min(kLargest, options.largest) ||
            (jumps && (bank.radii() == 0 || jumping >= options.jumps))) {
            break;
        }
        double own = 0;
        std::vector<Record> records;
        records.reserve(BallBank::kRecords);
        for_each_block_in_order(
            BallBank::kRecords, 1024, context,
            [&](Range range) {
                Part part;
                for (std::size_t i = range.begin; i < range.end; ++i) {
                    WalkRandom random(
                        {options.seed, RandomStage::body_walk,
                         kFirstStart + 256 * options.number + k, static_cast<std::uint32_t>(i)},
                        true);
                    part.record.push_back(walk(radius, jumps, random, part.events));
                }
                return part;
            },
            [&](Range, Part&& part) {
                own += part.events;
                records.insert(records.end(), part.record.begin(), part.record.end());
            });
        if (records.size() < BallBank::kRecords) break;
        (jumps ? jumping : events) += own;
        if (!jumps) {
            of_next =
                own * std::exp2(2 / kStepsPerOctave);  // in proportion to the square of the radius
        }
        bank.radius_.push_back(radius);
        bank.record_.insert(bank.record_.end(), records.begin(), records.end());
    }
    return bank;
}

PhaseTable make_phase_table(const formats::PhaseFunction& phase) {
    using Type = formats::PhaseFunction::Type;
    PhaseTable table;
    table.type = phase.type;
    table.g = static_cast<double>(phase.g);
    if (phase.type == Type::isotropic || phase.type == Type::henyey_greenstein) return table;
    // Steps of s, cosine = 1 - 2 s^2: fine where functions have their peak. p dcosine = 4 s p ds.
    constexpr std::size_t kFineSteps = 65536, kStored = 4096;
    const PhaseDensity density = make_phase_density(phase);
    const auto cosine_at = [](double s) { return 1 - 2 * s * s; };
    std::vector<double> cumulative{0};
    for (std::size_t i = 0; i < kFineSteps; ++i) {
        const double s = (static_cast<double>(i) + 0.5) / kFineSteps;
        cumulative.push_back(cumulative.back() + s * eval_phase(density, cosine_at(s)));
    }
    std::size_t at = 0;
    for (std::size_t k = 0; k <= kStored; ++k) {
        const double wanted = cumulative.back() * static_cast<double>(k) / kStored;
        while (at + 1 < kFineSteps && cumulative[at + 1] < wanted) {
            ++at;
        }
        const double width = cumulative[at + 1] - cumulative[at];
        const double part = width > 0 ? std::clamp((wanted - cumulative[at]) / width, 0.0, 1.0) : 0;
        table.cosine.push_back(
            static_cast<float>(cosine_at((static_cast<double>(at) + part) / kFineSteps)));
    }
    return table;
}

double mean_cosine(const PhaseTable& table) {
    if (table.cosine.empty()) return table.g;
    double sum = 0;
    for (std::size_t i = 0; i + 1 < table.cosine.size(); ++i) {
        sum += 0.5 * static_cast<double>(table.cosine[i] + table.cosine[i + 1]);
    }
    return sum / static_cast<double>(table.cosine.size() - 1);
}

float sample_cosine(const PhaseTable& table, float u) {
    if (!table.cosine.empty()) {
        const float place = u * static_cast<float>(table.cosine.size() - 1);
        const auto i = std::min(static_cast<std::size_t>(place), table.cosine.size() - 2);
        const float part = place - static_cast<float>(i);
        return table.cosine[i] + part * (table.cosine[i + 1] - table.cosine[i]);
    }
    const double x = static_cast<double>(u), g = table.g;
    if (std::abs(g) < 1e-4) {
        // To first order in g; the closed form divides by it.
        const double c = 1 - 2 * x;
        return static_cast<float>(std::clamp(c + 1.5 * g * (1 - c * c), -1.0, 1.0));
    }
    const double s = (1 - g * g) / (1 + g - 2 * g * x);
    return static_cast<float>(std::clamp((1 + g * g - s * s) / (2 * g), -1.0, 1.0));
}

glm::vec3 scatter(const PhaseTable& table, glm::vec3 direction, float u, float v) {
    const float cosine = sample_cosine(table, u);
    const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
    const float azimuth = 2 * std::numbers::pi_v<float> * v;
    const glm::vec3 turned = make_frame(direction).to_world(
        {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine});
    return glm::normalize(turned);  // thousands of turns would add up their rounding
}

}  // namespace opaline::bake
