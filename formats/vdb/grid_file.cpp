#include "formats/vdb/grid_file.h"

#include <openvdb/openvdb.h>

#include <ios>
#include <stdexcept>

#include "formats/vdb/limits.h"

namespace opaline::formats::vdb {
namespace {

using openvdb::GridBase;

bool has_known_values(const GridBase& grid) {
    return grid.isType<openvdb::FloatGrid>() || grid.isType<openvdb::Vec3SGrid>();
}

}  // namespace

GridFile::GridFile(const std::string& path) : buffer_(1u << 20) {
    stream_.rdbuf()->pubsetbuf(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    stream_.exceptions(std::ios::failbit | std::ios::badbit);
    stream_.open(path, std::ios::binary);
    read_header();
    openvdb::MetaMap metadata;
    metadata.readMeta(stream_);
    const std::int32_t count = readGridCount(stream_);
    if (count < 0 || count > kMaxGridsInFile) {
        throw std::runtime_error("it lists " + std::to_string(count) + " grids");
    }
    for (std::int32_t i = 0; i < count; ++i) {
        read_listed(grids_.emplace_back());
    }
    // Not all grids may be read: that the last one is there shows that the file is whole.
    const auto end = stream_.tellg();
    stream_.seekg(0, std::ios::end);
    if (stream_.tellg() < end) throw std::ios_base::failure("end of file");
}

void GridFile::read_header() {
    // Before OpenVDB takes a header of another version apart.
    constexpr std::uint32_t kOldest = openvdb::OPENVDB_FILE_VERSION_FLOAT_FRUSTUM_BBOX;
    constexpr std::uint32_t kNewest = openvdb::OPENVDB_FILE_VERSION;
    std::uint32_t version = 0;
    stream_.seekg(sizeof(std::int64_t));
    stream_.read(reinterpret_cast<char*>(&version), sizeof(version));
    if (version < kOldest || version > kNewest) {
        throw std::runtime_error("its format version is " + std::to_string(version) + ", and " +
                                 std::to_string(kOldest) + " to " + std::to_string(kNewest) +
                                 " can be read");
    }
    stream_.seekg(0);
    readHeader(stream_);
    stream_metadata_ = std::make_shared<openvdb::io::StreamMetadata>();
    openvdb::io::setStreamMetadataPtr(stream_, stream_metadata_, /*transfer=*/false);
    setFormatVersion(stream_);
    setLibraryVersion(stream_);
    setDataCompression(stream_);
}

// The descriptor and, after it, what is to be known before a tree is read. Leaves the stream where
// the next descriptor begins.
void GridFile::read_listed(ListedGrid& listed) {
    openvdb::io::GridDescriptor& descriptor = listed.descriptor;
    try {
        listed.grid = descriptor.read(stream_);
    } catch (const openvdb::LookupError&) {
        skip_unknown(listed);
        return;
    }
    listed.name = openvdb::io::GridDescriptor::nameAsString(descriptor.uniqueName());
    if (!inputHasGridOffsets()) {
        readGrid(listed.grid, descriptor, stream_);
        if (!has_known_values(*listed.grid)) {
            listed.grid->newTree();
        }
        return;
    }
    try {
        descriptor.seekToGrid(stream_);
        readGridCompression(stream_);
        listed.grid->readMeta(stream_);
        listed.grid->readTransform(stream_);
    } catch (const openvdb::ArithmeticError&) {
        listed.fault = "its transform is singular, or not affine";
    }
    descriptor.seekToEnd(stream_);
}

// OpenVDB stops reading a descriptor before the three positions where it does not know the type.
void GridFile::skip_unknown(ListedGrid& listed) {
    listed.name = openvdb::io::GridDescriptor::nameAsString(listed.descriptor.uniqueName());
    if (!inputHasGridOffsets()) {
        throw std::runtime_error("the type of grid '" + listed.name + "' is unknown");
    }
    std::int64_t position[3];
    stream_.read(reinterpret_cast<char*>(position), sizeof(position));
    stream_.seekg(position[2]);
}

GridBase::Ptr GridFile::load_tree(const ListedGrid& listed) {
    const ListedGrid* owner = &listed;
    if (listed.descriptor.isInstance()) {
        for (const ListedGrid& other : grids_) {
            if (other.descriptor.uniqueName() == listed.descriptor.instanceParentName()) {
                owner = &other;
            }
        }
        if (owner == &listed || owner->descriptor.isInstance() || owner->grid == nullptr) {
            throw std::runtime_error("the grid that shares its tree with '" + listed.name +
                                     "' is missing");
        }
    }
    if (!inputHasGridOffsets()) return owner->grid;
    GridBase::Ptr grid = GridBase::createGrid(owner->descriptor.gridType());
    grid->setSaveFloatAsHalf(owner->descriptor.saveFloatAsHalf());
    owner->descriptor.seekToGrid(stream_);
    readGrid(grid, owner->descriptor, stream_);
    return grid;
}

}  // namespace opaline::formats::vdb
