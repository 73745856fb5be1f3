#pragma once

#include <cstddef>
#include <string>
#include <utility>

namespace opaline::formats {

/// What is wrong with an asset; `what` is empty where nothing is.
struct Fault {
    std::string where, what;
};

/// A number in such a text.
std::string number_in_fault(auto value) {
    return std::to_string(value);
}

inline bool is_sound(const Fault& fault) {
    return fault.what.empty();
}
inline bool is_sound(const std::string& fault) {
    return fault.empty();
}

/// What the first of these checks finds that finds something: a Fault, or its text alone.
template <class First, class... More>
auto find_first_fault(const First& first, const More&... more) {
    auto fault = first();
    (void)((is_sound(fault) && (fault = more(), true)) && ...);
    return fault;
}

/// The first fault that find(i) tells of, for i below `count`: in "PLACE i".
template <class Find>
Fault find_fault_in(const std::string& place, std::size_t count, const Find& find) {
    for (std::size_t i = 0; i < count; ++i) {
        if (std::string fault = find(i); !fault.empty()) {
            return {place + " " + number_in_fault(i), std::move(fault)};
        }
    }
    return {};
}

}  // namespace opaline::formats
