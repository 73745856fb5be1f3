#pragma once

#include <openvdb/Grid.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>

#include <fstream>
#include <string>
#include <vector>

namespace opaline::formats::vdb {

/// A grid that a file lists.
struct ListedGrid {
    openvdb::io::GridDescriptor descriptor;
    std::string name;  ///< "density", or "density[1]" where the name stands several times
    openvdb::GridBase::Ptr grid;  ///< with its metadata and transform, perhaps without its tree;
                                  ///< null: of a type that OpenVDB does not know
    std::string fault;            ///< why metadata or transform cannot be used; empty: they can
};

/// An OpenVDB file as this room reads it. openvdb::io::File would do, but takes no notice of the
/// end of the file: it makes up values for what is missing, and it does not list grids of unknown
/// types. All functions throw exceptions of OpenVDB and of the standard library for damaged files.
class GridFile : public openvdb::io::Archive {
  public:
    /// Lists the grids. Files without positions of the grids (written to a pipe) are read whole.
    explicit GridFile(const std::string& path);

    const std::vector<ListedGrid>& grids() const { return grids_; }

    /// A grid with the tree of this one: read now, each time, unless the file was read whole. Its
    /// metadata and transform may be those of another grid that shares the tree.
    openvdb::GridBase::Ptr load_tree(const ListedGrid& listed);

  private:
    void read_header();
    void read_listed(ListedGrid& listed);
    void skip_unknown(ListedGrid& listed);

    openvdb::io::StreamMetadata::Ptr stream_metadata_;
    std::vector<char> buffer_;
    std::ifstream stream_;
    std::vector<ListedGrid> grids_;
};

}  // namespace opaline::formats::vdb
