#include "formats/gltf/read_accessor.h"

#include <algorithm>
#include <cstring>

namespace opaline::formats::gltf {

namespace {

template <class Stored>
Stored load(const std::byte* at) {
    Stored value;
    std::memcpy(&value, at, sizeof value);  // the file promises no alignment that we could trust
    return value;
}

float to_float(const std::byte* at, ComponentType type, bool normalized) {
    switch (type) {
        case ComponentType::int8: {
            const auto c = static_cast<float>(load<std::int8_t>(at));
            return normalized ? std::max(c / 127.0f, -1.0f) : c;
        }
        case ComponentType::uint8: {
            const auto c = static_cast<float>(load<std::uint8_t>(at));
            return normalized ? c / 255.0f : c;
        }
        case ComponentType::int16: {
            const auto c = static_cast<float>(load<std::int16_t>(at));
            return normalized ? std::max(c / 32767.0f, -1.0f) : c;
        }
        case ComponentType::uint16: {
            const auto c = static_cast<float>(load<std::uint16_t>(at));
            return normalized ? c / 65535.0f : c;
        }
        case ComponentType::uint32: {
            const auto c = static_cast<float>(load<std::uint32_t>(at));
            return normalized ? c / 4294967295.0f : c;
        }
        case ComponentType::float32:
            return load<float>(at);
    }
    return 0.0f;
}

std::uint32_t to_index(const std::byte* at, ComponentType type) {
    switch (type) {
        case ComponentType::uint8:
            return load<std::uint8_t>(at);
        case ComponentType::uint16:
            return load<std::uint16_t>(at);
        default:
            return load<std::uint32_t>(at);
    }
}

struct Run {
    const std::byte* first = nullptr;
    std::size_t stride = 0;
};

Run run_of(const Document& document, const std::vector<Bytes>& buffers, std::uint32_t view_index,
           std::uint64_t offset, std::uint64_t element) {
    const BufferView& view = document.views[view_index];
    return {buffers[view.buffer].data() + view.offset + offset,
            view.stride == 0 ? element : view.stride};
}

template <class T, class Convert>
AccessorValues<T> read(const Document& document, const std::vector<Bytes>& buffers,
                       const Accessor& accessor, const Convert& convert) {
    const std::size_t components = accessor.components;
    const std::size_t component = component_bytes(accessor.type);
    AccessorValues<T> out;
    out.value.assign(accessor.count * components, T{});
    const auto copy = [&](const std::byte* from, std::size_t element) {
        for (std::size_t c = 0; c < components; ++c) {
            out.value[element * components + c] = convert(from + c * component);
        }
    };
    if (accessor.view != kNone) {
        const Run run =
            run_of(document, buffers, accessor.view, accessor.offset, components * component);
        for (std::size_t i = 0; i < accessor.count; ++i) {
            copy(run.first + i * run.stride, i);
        }
    }
    if (accessor.sparse) {
        const Sparse& sparse = *accessor.sparse;
        const Run where = run_of(document, buffers, sparse.index_view, sparse.index_offset,
                                 component_bytes(sparse.index_type));
        const Run what = run_of(document, buffers, sparse.value_view, sparse.value_offset,
                                components * component);
        for (std::size_t i = 0; i < sparse.count; ++i) {
            const std::size_t element = to_index(where.first + i * where.stride, sparse.index_type);
            if (element >= accessor.count) {
                out.sparse_index_bad = true;
                continue;
            }
            copy(what.first + i * what.stride, element);
        }
    }
    return out;
}

}  // namespace

AccessorValues<float> read_floats(const Document& document, const std::vector<Bytes>& buffers,
                                  std::uint32_t accessor) {
    const Accessor& source = document.accessors[accessor];
    return read<float>(document, buffers, source, [&](const std::byte* at) {
        return to_float(at, source.type, source.normalized);
    });
}

AccessorValues<std::uint32_t> read_indices(const Document& document,
                                           const std::vector<Bytes>& buffers,
                                           std::uint32_t accessor) {
    const Accessor& source = document.accessors[accessor];
    return read<std::uint32_t>(document, buffers, source,
                               [&](const std::byte* at) { return to_index(at, source.type); });
}

}  // namespace opaline::formats::gltf
