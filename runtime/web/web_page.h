#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/environment.h"
#include "formats/opal/result.h"
#include "runtime/clouds/layer_light.h"

namespace opaline::runtime {

/// A light that the page offers, by the name that it shows.
struct PageLight {
    std::string name;
    formats::Environment environment;
};

/// What an asset needs of a light beside its radiance.
struct PageLightNeeds {
    std::vector<std::uint32_t> levels;  ///< SpecularNeeds
    bool gloss = false;
};

/// A script that hands a light to the page under the name `owner`, as the page projects and shows
/// it: as divide_light.h has it; what eyes see, at most 1024 x 512 pixels; cells and blurred maps
/// for gloss, if needed. Radiance is stored as halves times a scale: it errs by 2^-11 down to 1e-9
/// of the brightest pixel, that of the background by 2^-9.
/// `above`: where the asset has a cloud layer, this light above it at time 0: the page itself finds
/// what is below and what that needs.
std::string make_light_script(const std::string& owner, const PageLight& light,
                              const LayerLight* above, const PageLightNeeds& needs,
                              unsigned threads);

/// A file of a page's folder.
struct PageFile {
    std::string name, text;
};

/// Most bytes of an asset's arrays that a page holds: scripts are strings to a browser, of which
/// some end at 512 MiB.
inline constexpr std::uint64_t kMostPageBytes = 256u << 20;

/// Most volumes that a page draws, as kMaxGlVolumes.
inline constexpr std::size_t kMostPageVolumes = 4;

/// The files of a page that shows surfaces and volumes of an asset under lights, one at least: it
/// needs WebGL 2, no server, no network and no other file. `title` heads it. The page shows what
/// `render_software` does, to rounding. `threads` 0: all cores; the files have the same bytes for
/// any number. Errors: bad_input, for an asset without surfaces and volumes or beyond the limits
/// above; `file` is for them.
formats::Result<std::vector<PageFile>> make_web_page(const formats::AssetView& asset,
                                                     std::span<const PageLight> lights,
                                                     const std::string& title,
                                                     const std::string& file, unsigned threads);

/// Whether a file of that name may be one of a page.
bool is_page_file(std::string_view name);

}  // namespace opaline::runtime
