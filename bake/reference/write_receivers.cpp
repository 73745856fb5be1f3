#include "bake/reference/write_receivers.h"

#include <array>
#include <charconv>
#include <string>

#include "formats/opal/atomic_file.h"

namespace opaline::bake {
namespace {

void append_number(std::string& text, double value) {
    std::array<char, 32> digits{};
    const auto [end, error] =
        std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<float>(value),
                      std::chars_format::general, 9);
    text += ',';
    text.append(digits.data(), end);
}

}  // namespace

formats::Status write_receiver_csv(const std::filesystem::path& path,
                                   std::span<const ReferenceReceiver> receivers,
                                   const Estimate& estimate) {
    std::string text = "primitive,vertex,r,g,b,se_r,se_g,se_b\n";
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        text += std::to_string(receivers[i].primitive) + ',' + std::to_string(receivers[i].vertex);
        const Moments& m = estimate.pixel[i];
        const glm::dvec3 error = glm::sqrt(m.variance_of_mean());
        for (const glm::dvec3& value : {m.mean, error}) {
            for (int c = 0; c < 3; ++c) {
                append_number(text, value[c]);
            }
        }
        text += '\n';
    }
    return formats::write_file_atomically(path, text);
}

}  // namespace opaline::bake
