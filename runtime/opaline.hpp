/// C++ handles over opaline.h: they release what they own and nothing more. Header only, C++17, no
/// exceptions; call the C functions with `handle.get()`.
#ifndef OPALINE_HPP
#define OPALINE_HPP

#if !defined(__cplusplus) || __cplusplus < 201703L
#error "opaline.hpp needs C++17; opaline.h is enough for C99 and earlier C++"
#endif

#include <cstddef>
#include <memory>

#include "opaline.h"

namespace opaline {

struct Releaser {
    void operator()(opaline_asset* asset) const noexcept { opaline_asset_release(asset); }
    void operator()(opaline_light* light) const noexcept { opaline_light_release(light); }
    void operator()(opaline_volume_light* light) const noexcept {
        opaline_volume_light_release(light);
    }
};

using AssetHandle = std::unique_ptr<opaline_asset, Releaser>;
using LightHandle = std::unique_ptr<opaline_light, Releaser>;
using VolumeLightHandle = std::unique_ptr<opaline_volume_light, Releaser>;

/// A handle or, where it is empty, the reason.
template <class Handle>
struct Made {
    Handle handle;
    opaline_status status = OPALINE_OK;
    explicit operator bool() const noexcept { return status == OPALINE_OK; }
};

/// See opaline_asset_load: `bytes`, aligned to 64, must outlive the handle.
[[nodiscard]] inline Made<AssetHandle> load_asset(const void* bytes, std::size_t size) noexcept {
    opaline_asset* asset = nullptr;
    const opaline_status status = opaline_asset_load(bytes, size, &asset);
    return {AssetHandle(asset), status};
}

/// See opaline_asset_load_path.
[[nodiscard]] inline Made<AssetHandle> load_asset(const char* path) noexcept {
    opaline_asset* asset = nullptr;
    const opaline_status status = opaline_asset_load_path(path, &asset);
    return {AssetHandle(asset), status};
}

/// See opaline_light_create.
[[nodiscard]] inline Made<LightHandle> create_light(const AssetHandle& asset) noexcept {
    opaline_light* light = nullptr;
    const opaline_status status = opaline_light_create(asset.get(), &light);
    return {LightHandle(light), status};
}

/// See opaline_volume_light_create.
[[nodiscard]] inline Made<VolumeLightHandle> create_volume_light(
    const AssetHandle& asset) noexcept {
    opaline_volume_light* light = nullptr;
    const opaline_status status = opaline_volume_light_create(asset.get(), &light);
    return {VolumeLightHandle(light), status};
}

}  // namespace opaline

#endif
