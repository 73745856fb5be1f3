#include <functional>
#include <map>
#include <string>

#include "bake/physics/path_differentials/axis_frame.h"
#include "bake/physics/path_differentials/path_differential.h"
#include "bake/physics/path_differentials/surface_shape.h"
#include "bake/scene/sample_image.h"
#include "tests/bake/path_differentials/event_check.h"
#include "tests/support/named_table.h"
#include "tests/support/reference_table.h"

namespace opaline::bake {
namespace {

using NamedValues = std::map<std::string, std::vector<double>>;

/// All rows of one case of path-differentials.csv (tests/data/reference/README.md).
struct DifferentialCase {
    std::string event, name;
    NamedValues in, out;
    std::map<std::string, double> tolerance;  ///< of each output, relative to its largest component

    double number(const std::string& key) const { return in.at(key).at(0); }
    glm::dvec2 pair(const std::string& key) const { return {in.at(key).at(0), in.at(key).at(1)}; }
    glm::dvec3 vector(const std::string& key) const { return {pair(key), in.at(key).at(2)}; }
};

std::vector<DifferentialCase> read_differential_cases() {
    std::vector<DifferentialCase> cases;
    for (const auto& row :
         tests::read_named_table(tests::reference_folder() / "path-differentials.csv")) {
        if (cases.empty() || cases.back().event != row.at("event") ||
            cases.back().name != row.at("case")) {
            cases.push_back({row.at("event"), row.at("case"), {}, {}, {}});
        }
        const std::string& name = row.at("name");
        const bool is_input = row.at("role") == "in";
        (is_input ? cases.back().in : cases.back().out)[name].push_back(std::stod(row.at("value")));
        if (!is_input) {
            cases.back().tolerance[name] = std::stod(row.at("rtol"));
        }
    }
    return cases;
}

std::vector<double> listed(double v) {
    return {v};
}
std::vector<double> listed(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

double area_of(const glm::dvec3& du, const glm::dvec3& dv) {
    return glm::length(glm::cross(du, dv));
}

NamedValues transfer(const DifferentialCase& row) {
    const glm::dvec3 P = row.vector("P"), D = row.vector("D");
    const bool to_plane = row.event == "transfer_plane";
    const double t =
        to_plane ? tests::plane_distance<double>(P, D, row.vector("N"), row.vector("Q"))
                 : tests::sphere_distance<double>(P, D, row.vector("center"), row.number("radius"));
    const glm::dvec3 end = P + t * D;
    const glm::dvec3 N =
        to_plane ? row.vector("N") : (end - row.vector("center")) / row.number("radius");
    NamedValues found{{"t", listed(t)}, {"P1", listed(end)}};
    if (std::abs(glm::dot(N, D)) > kLeastGrazing * glm::length(D)) {  // else it is bounded
        found["dP1_j"] = listed(bounded_transfer(D, N, t, row.vector("dP"), row.vector("dD")));
    }
    return found;
}

NamedValues reflection(const DifferentialCase& row) {
    const Mirror event = make_mirror(row.vector("D"), row.vector("N"));
    return {{"R", listed(event.reflected)},
            {"dR_j", listed(event.change(row.vector("dD"), row.vector("dN")))}};
}

NamedValues refraction(const DifferentialCase& row) {
    const auto event = make_refraction(row.vector("D"), row.vector("N"), row.number("eta"));
    return event ? NamedValues{{"T", listed(event->refracted)},
                               {"dT_j", listed(event->change(row.vector("dD"), row.vector("dN")))}}
                 : NamedValues{};
}

NamedValues normal(const DifferentialCase& row) {
    const SurfaceShape shape =
        interpolated_shape({row.vector("A"), row.vector("B"), row.vector("C")},
                           {row.vector("Na"), row.vector("Nb"), row.vector("Nc")}, row.vector("P"));
    return {{"N", listed(shape.N)}, {"dN_j", listed(shape.dN_dP * row.vector("dP"))}};
}

NamedValues frame(const DifferentialCase& row) {
    const glm::dmat3 axes = frame_around(row.vector("N"));
    return {{"T", listed(axes[0])}, {"B", listed(axes[1])}};
}

NamedValues lobe(const DifferentialCase& row) {
    const Lobe shape = row.event == "hg" ? Lobe{Lobe::Kind::henyey_greenstein, row.number("g")}
                                         : Lobe{Lobe::Kind::power, row.number("S")};
    const LobeDirection at = sample_lobe(shape, row.number("u"), row.number("v"));
    const double area = area_of(at.dD_du, at.dD_dv);
    return {{"D", listed(at.D)},
            {"dD_u", listed(at.dD_du)},
            {"dD_v", listed(at.dD_dv)},
            {"inv_pdf", listed(area)},
            {"area", listed(area)}};
}

NamedValues facet(const DifferentialCase& row) {
    const glm::dvec3 w_i = row.vector("wi"), dw_i = row.vector("dwi");
    const VisibleNormal at = sample_visible_normal(w_i, {row.number("ax"), row.number("ay")},
                                                   row.number("u"), row.number("v"));
    const Mirror mirror = make_mirror(-w_i, at.m);
    const bool refracts = row.event == "ggx_refract";
    const auto refraction = make_refraction(-w_i, at.m, refracts ? row.number("eta") : 1);
    if (!refraction) {
        return {};
    }
    const auto change = [&](const glm::dvec3& dw, const glm::dvec3& dm) {
        return refracts ? refraction->change(-dw, dm) : mirror.change(-dw, dm);
    };
    const glm::dvec3 du = change(glm::dvec3(0), at.dm_du), dv = change(glm::dvec3(0), at.dm_dv);
    return {{"wm", listed(at.m)},
            {"wo", listed(refracts ? refraction->refracted : mirror.reflected)},
            {"dwm_u", listed(at.dm_du)},
            {"dwm_v", listed(at.dm_dv)},
            {"dwm_j", listed(at.dm_dwi * dw_i)},
            {"dwo_u", listed(du)},
            {"dwo_v", listed(dv)},
            {"dwo_j", listed(change(dw_i, at.dm_dwi * dw_i))},
            {"inv_pdf", listed(area_of(du, dv))}};
}

NamedValues area_light(const DifferentialCase& row) {
    const std::array<glm::dvec3, 3> corners{row.vector("A"), row.vector("B"), row.vector("C")};
    const double u = row.number("u"), v = row.number("v");
    const AreaSample at = row.event == "rectangle"
                              ? sample_parallelogram(corners[0], corners[1] - corners[0],
                                                     corners[2] - corners[0], u, v)
                              : sample_triangle_folded(corners, u, v);
    return {{"P", listed(at.P)},
            {"dP_u", listed(at.dP_du)},
            {"dP_v", listed(at.dP_dv)},
            {"inv_pdf", listed(area_of(at.dP_du, at.dP_dv))}};
}

NamedValues steps(const DifferentialCase& row) {
    return {{"global", listed(global_step(row.number("N"), static_cast<int>(row.number("M")),
                                          row.number("survival")))}};
}

NamedValues footprint(const DifferentialCase& row) {
    std::vector<glm::dvec2> vectors;
    for (const auto& [name, value] : row.in) {
        vectors.push_back(row.pair(name));
    }
    const PairExtent rms = pair_extent(rms_pair(vectors));
    return {{"area_polygon", listed(polygon_area(vectors))},
            {"area_best", listed(pair_area(best_pair(vectors)))},
            {"rms_major", listed(rms.major)},
            {"rms_minor", listed(rms.minor)}};
}

NamedValues mip(const DifferentialCase& row) {
    UvMoments moments;
    moments.add(row.pair("dA"));
    moments.add(row.pair("dB"));
    const TextureTaps taps = texture_taps(moments, glm::dvec2(row.number("res")),
                                          static_cast<int>(row.number("max_samples")));
    return {{"major_texels", listed(taps.major)},
            {"minor_texels", listed(taps.minor)},
            {"samples", listed(taps.count)},
            {"level", listed(taps.level)}};
}

// The events that paths of the program take. Their other map of the disk is not the program's.
TEST(PathDifferentialTable, EveryRowOfAnEventIsReproduced) {
    OPALINE_NEEDS_REFERENCE("path-differentials.csv");
    const std::map<std::string, std::function<NamedValues(const DifferentialCase&)>> events{
        {"transfer_plane", transfer},
        {"transfer_sphere", transfer},
        {"reflect", reflection},
        {"refract", refraction},
        {"normal_interp", normal},
        {"frame_branchless", frame},
        {"lobe", lobe},
        {"hg", lobe},
        {"ggx_reflect", facet},
        {"ggx_refract", facet},
        {"triangle_folded", area_light},
        {"rectangle", area_light},
        {"delta", steps},
        {"footprint", footprint},
        {"mip", mip}};
    std::map<std::string, int> reproduced;
    for (const DifferentialCase& row : read_differential_cases()) {
        const auto found = events.find(row.event);
        if (found == events.end() || (row.in.contains("map") && row.number("map") == 0)) continue;
        const NamedValues computed = found->second(row);
        EXPECT_EQ(computed.empty(), row.out.empty()) << row.event << " " << row.name;
        ++reproduced[row.event];
        for (const auto& [name, values] : computed) {
            const std::string label = row.event + " " + row.name + " " + name;
            const std::vector<double>& expected = row.out.at(name);
            ASSERT_EQ(values.size(), expected.size()) << label;
            double largest = 0;
            for (const double v : expected) {
                largest = std::max(largest, std::abs(v));
            }
            const double tolerance = largest > 0 ? row.tolerance.at(name) * largest : 1e-300;
            for (std::size_t i = 0; i < expected.size(); ++i) {
                EXPECT_NEAR(values[i], expected[i], tolerance) << label << " " << i;
            }
        }
    }
    EXPECT_EQ(reproduced.size(), events.size());
}

}  // namespace
}  // namespace opaline::bake
