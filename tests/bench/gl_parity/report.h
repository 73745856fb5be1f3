#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace opaline::parity {

/// What is compared, a column of the table each.
enum class Kind { receivers, surfaces, images, normal_maps, rays, points, layers };
inline constexpr std::size_t kKinds = 7;
inline constexpr std::array<const char*, kKinds> kKindNames{
    "receivers", "surfaces", "images", "normal maps", "rays", "points", "layers"};

/// As the tests of Opaline::gl have it, of every kind.
inline constexpr double kTolerance = 1e-5;

/// Differences between an OpenGL context and the CPU.
class Report {
  public:
    /// A difference in units of the kind's scale; not a number counts as infinite. `of`: which
    /// values these are, `number`: which of them.
    void compare(Kind kind, double difference, std::string_view of, std::size_t number,
                 double tolerance = kTolerance);
    /// A difference beyond the tolerance where the CPU's own values change as fast
    /// (conditioning.h): told apart.
    void compare_step(Kind kind, double difference, std::string_view of, std::size_t number);
    /// Something that cannot be compared, and why.
    void note(const std::string& text) { notes_.push_back(text); }

    /// Nothing is beyond its tolerance, and of no kind more than one value in fifty is a step.
    bool holds() const;
    /// The table's row, then a line for what is beyond its tolerance, for steps and for each note.
    std::string text(const std::string& file, const std::string& context) const;

  private:
    struct Largest {
        std::size_t count = 0, beyond = 0, steps = 0;
        double difference = 0, step = 0;
        double excess = 0;  // the largest share of a tolerance, which is that of:
        double found = 0, tolerance = 0;
        std::string of, of_step;
        std::size_t number = 0;
    };
    std::array<Largest, kKinds> kinds_;
    std::vector<std::string> notes_;
};

}  // namespace opaline::parity
