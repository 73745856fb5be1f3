#pragma once

#include <vector>

#include "formats/opal/receiver_errors.h"
#include "tests/formats/opal/asset_fixture.h"
#include "tests/formats/opal/opal_bytes.h"

namespace opaline::tests {

/// One error for each receiver of make_small_asset: v / 64.
inline std::vector<float> make_receiver_errors() {
    std::vector<float> errors;
    for (std::size_t v = 0; v < make_small_asset().position.size(); ++v) {
        errors.push_back(static_cast<float>(v) / 64);
    }
    return errors;
}

/// An asset with errors by receiver, as bytes of a file.
inline std::vector<std::byte> encode_with_errors(const std::vector<float>& errors,
                                                 const formats::Asset& asset = make_small_asset()) {
    const TemporaryFolder folder;
    auto file = formats::AtomicFile::create(folder / "a.opal");
    EXPECT_TRUE(file);
    EXPECT_TRUE(formats::write_opal_bytes(asset.view(), *file, errors));
    EXPECT_TRUE(file->commit());
    auto mapped = formats::FileBytes::open(folder / "a.opal");
    EXPECT_TRUE(mapped);
    return {mapped->bytes().begin(), mapped->bytes().end()};
}

}  // namespace opaline::tests
