#include <functional>

#include "bake/path_differentials/area_sample.h"
#include "bake/path_differentials/axis_frame.h"
#include "bake/path_differentials/footprint.h"
#include "bake/path_differentials/lobe.h"
#include "bake/path_differentials/smooth_event.h"
#include "bake/path_differentials/steps.h"
#include "bake/path_differentials/surface_shape.h"
#include "bake/path_differentials/visible_normal.h"
#include "bake/scene/texture_taps.h"
#include "tests/bake/path_differentials/camera_start.h"
#include "tests/bake/path_differentials/environment_sample.h"
#include "tests/bake/path_differentials/flight_sample.h"
#include "tests/bake/path_differentials/glossy_chain.h"
#include "tests/bake/path_differentials/path_gradient.h"
#include "tests/bake/path_differentials/primal.h"
#include "tests/bake/path_differentials/table_case.h"
#include "tests/bake/path_differentials/transfer.h"

namespace opaline::bake {
namespace {

using tests::DifferentialCase;
using tests::Dual;
using tests::listed;
using tests::NamedValues;
using tests::Vector;

DiskMap map_of(const DifferentialCase& row) {
    return row.number("map") == 0 ? DiskMap::polar : DiskMap::concentric;
}

double area_of(const glm::dvec3& du, const glm::dvec3& dv) {
    return glm::length(glm::cross(du, dv));
}

PinholeCamera camera_of(const DifferentialCase& row) {
    const glm::dvec3 eye = row.in.contains("eye") ? row.vector("eye") : glm::dvec3(0);
    return {eye, row.vector("view"), row.vector("right"), row.vector("up")};
}

NamedValues pixel(const DifferentialCase& row) {
    // The table's `view` already points to the pixel, or x and y still move it.
    const CameraStart at = start_at_pinhole(camera_of(row), row.number("x"), row.number("y"));
    return {{"D", listed(at.D)}, {"dD_x", listed(at.dD_dx)}, {"dD_y", listed(at.dD_dy)}};
}

NamedValues lens(const DifferentialCase& row) {
    const CameraStart at =
        start_at_lens({camera_of(row), row.vector("lens_x"), row.vector("lens_y")}, row.number("x"),
                      row.number("y"), row.number("u"), row.number("v"));
    const std::vector<double> none{0, 0, 0};
    return {{"P", listed(at.P)},
            {"D", listed(at.D)},
            {"dP_x", none},
            {"dP_y", none},
            {"dD_x", listed(at.dD_dx)},
            {"dD_y", listed(at.dD_dy)},
            {"dP_u", listed(at.dP_du)},
            {"dD_u", listed(at.dD_du)},
            {"dP_v", listed(at.dP_dv)},
            {"dD_v", listed(at.dD_dv)}};
}

NamedValues transfer(const DifferentialCase& row) {
    const glm::dvec3 P = row.vector("P"), D = row.vector("D");
    const bool to_plane = row.event == "transfer_plane";
    const double t =
        to_plane ? tests::plane_distance<double>(P, D, row.vector("N"), row.vector("Q"))
                 : tests::sphere_distance<double>(P, D, row.vector("center"), row.number("radius"));
    const glm::dvec3 end = P + t * D;
    const SurfaceShape shape =
        to_plane ? SurfaceShape{row.vector("N"), glm::dmat3(0.0), glm::dmat3x2(0.0)}
                 : sphere_shape(row.vector("center"), row.number("radius"), end);
    const TransferChange change =
        transfer_to_plane(D, shape.N, t, row.vector("dP"), row.vector("dD"));
    return {{"t", listed(t)},
            {"P1", listed(end)},
            {"dt_j", listed(change.dt)},
            {"dP1_j", listed(change.dP)},
            {"N", listed(shape.N)},
            {"dN_j", listed(shape.dN_dP * change.dP)}};
}

NamedValues reflection(const DifferentialCase& row) {
    const Mirror event = make_mirror(row.vector("D"), row.vector("N"));
    return {{"R", listed(event.reflected)},
            {"dR_j", listed(event.change(row.vector("dD"), row.vector("dN")))}};
}

NamedValues refraction(const DifferentialCase& row) {
    const auto event = make_refraction(row.vector("D"), row.vector("N"), row.number("eta"));
    if (!event) {
        return {};
    }
    return {{"T", listed(event->refracted)},
            {"dT_j", listed(event->change(row.vector("dD"), row.vector("dN")))},
            {"dT_eta", listed(event->change_with_eta())}};
}

NamedValues normal(const DifferentialCase& row) {
    const TriangleGradients at =
        triangle_gradients({row.vector("A"), row.vector("B"), row.vector("C")}, row.vector("P"));
    const SurfaceShape shape =
        interpolated_shape(at, {{row.vector("Na"), row.vector("Nb"), row.vector("Nc")},
                                {row.pair("uva"), row.pair("uvb"), row.pair("uvc")}});
    const glm::dvec3 dP = row.vector("dP");
    const glm::dvec2 uv =
        at.bary.x * row.pair("uva") + at.bary.y * row.pair("uvb") + at.bary.z * row.pair("uvc");
    return {{"bary", listed(at.bary)},
            {"N", listed(shape.N)},
            {"uv", listed(uv)},
            {"dbary_j",
             {glm::dot(at.gradient[0], dP), glm::dot(at.gradient[1], dP),
              glm::dot(at.gradient[2], dP)}},
            {"dN_j", listed(shape.dN_dP * dP)},
            {"duv_j", listed(shape.duv_dP * dP)}};
}

/// The frame's recipe, which serves no event: what it adds to the twist-free turn is spin.
NamedValues frame(const DifferentialCase& row) {
    const glm::dvec3 N = row.vector("N");
    const auto moving = tests::branchless_frame(tests::moved(N, row.vector("dN"), Dual(0, 1)));
    const glm::dmat3 axes = frame_around(N);
    return {{"T", listed(axes[0])},
            {"B", listed(axes[1])},
            {"dT_j", listed(changes(moving[0]))},
            {"dB_j", listed(changes(moving[1]))},
            {"spin", listed(glm::dot(axes[1], changes(moving[0])))}};
}

NamedValues lobe(const DifferentialCase& row) {
    const bool is_phase = row.event == "hg";
    const Lobe shape{is_phase ? Lobe::Kind::henyey_greenstein : Lobe::Kind::power,
                     row.number(is_phase ? "g" : "S")};
    const LobeDirection at = sample_lobe(shape, map_of(row), row.number("u"), row.number("v"));
    return {{"D", listed(at.D)},
            {"dD_u", listed(at.dD_du)},
            {"dD_v", listed(at.dD_dv)},
            {"inv_pdf", listed(1 / at.pdf)},
            {"area", listed(area_of(at.dD_du, at.dD_dv))}};
}

NamedValues lobe_in_world(const DifferentialCase& row) {
    const glm::dvec3 R = row.vector("R"), dR = row.vector("dR");
    const LobeDirection at = sample_lobe({Lobe::Kind::power, row.number("S")}, map_of(row),
                                         row.number("u"), row.number("v"));
    const glm::dmat3 axes = frame_around(R);
    const glm::dvec3 D = axes * at.D, carried = carry_with_axis(R, dR, D);
    const auto moving = tests::branchless_frame(tests::moved(R, dR, Dual(0, 1)));
    const double spin = glm::dot(axes[1], changes(moving[0]));
    return {{"D", listed(D)},
            {"dD_u", listed(axes * at.dD_du)},
            {"dD_v", listed(axes * at.dD_dv)},
            {"dD_j_twistfree", listed(carried)},
            {"dD_j", listed(carried + spin * glm::cross(R, D))}};
}

NamedValues facet(const DifferentialCase& row) {
    const glm::dvec3 w_i = row.vector("wi"), dw_i = row.vector("dwi");
    const VisibleNormal at = sample_visible_normal(w_i, {row.number("ax"), row.number("ay")},
                                                   map_of(row), row.number("u"), row.number("v"));
    const Mirror mirror = make_mirror(-w_i, at.m);
    const auto refraction = make_refraction(-w_i, at.m, row.number_or("eta", 1));
    const bool refracts = row.event == "ggx_refract";
    if (!refraction) {
        return {};
    }
    const auto change = [&](const glm::dvec3& dw, const glm::dvec3& dm) {
        return refracts ? refraction->change(-dw, dm) : mirror.change(-dw, dm);
    };
    const glm::dvec3 w_o = refracts ? refraction->refracted : mirror.reflected;
    const double pdf =
        refracts ? pdf_of_refraction(at, w_i, w_o, row.number("eta")) : pdf_of_reflection(at, w_i);
    const glm::dvec3 du = change(glm::dvec3(0), at.dm_du), dv = change(glm::dvec3(0), at.dm_dv);
    return {{"wm", listed(at.m)},
            {"wo", listed(w_o)},
            {"dwm_u", listed(at.dm_du)},
            {"dwm_v", listed(at.dm_dv)},
            {"dwm_j", listed(at.dm_dwi * dw_i)},
            {"dwo_u", listed(du)},
            {"dwo_v", listed(dv)},
            {"dwo_j", listed(change(dw_i, at.dm_dwi * dw_i))},
            {"inv_pdf", listed(1 / pdf)},
            {"area", listed(area_of(du, dv))}};
}

NamedValues area_light(const DifferentialCase& row) {
    const std::array<glm::dvec3, 3> corners{row.vector("A"), row.vector("B"), row.vector("C")};
    const glm::dvec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
    const double u = row.number("u"), v = row.number("v");
    const AreaSample at = row.event == "rectangle" ? sample_parallelogram(corners[0], e1, e2, u, v)
                          : row.event == "triangle_sqrt" ? sample_triangle_sqrt(corners, u, v)
                                                         : sample_triangle_folded(corners, u, v);
    const double area = area_of(e1, e2) / (row.event == "rectangle" ? 1 : 2);
    return {{"P", listed(at.P)},
            {"dP_u", listed(at.dP_du)},
            {"dP_v", listed(at.dP_dv)},
            {"inv_pdf", listed(area)},
            {"area", listed(area_of(at.dP_du, at.dP_dv))}};
}

NamedValues connection(const DifferentialCase& row) {
    const glm::dvec3 NX = row.vector("NX"), NY = row.vector("NY");
    const glm::dvec3 dX = row.vector("dX"), dY = row.vector("dY");
    const Connection at = connect(row.vector("X"), row.vector("Y"));
    const glm::dvec3 dD = at.direction_change(dX, dY);
    const double dr = at.length_change(dX, dY);
    const double cosines = std::abs(glm::dot(NX, at.D) * glm::dot(NY, at.D));
    const double dln = dln_geometry(dln_cosine(NX, at.D, row.vector("dNX"), dD),
                                    dln_cosine(NY, at.D, row.vector("dNY"), dD), at.r, dr);
    return {{"D", listed(at.D)},
            {"r", listed(at.r)},
            {"lnG", listed(std::log(cosines / (at.r * at.r)))},
            {"dD_j", listed(dD)},
            {"dr_j", listed(dr)},
            {"dlnG_j", listed(dln)}};
}

NamedValues texel(const DifferentialCase& row) {
    const TexelChoice choice{
        row.vector("axis"), row.vector("S"),  row.vector("T"),  row.number("s0"), row.number("t0"),
        row.number("w"),    row.number("cx"), row.number("px"), row.number("cy"), row.number("py")};
    const EnvironmentSample at = sample_texel(choice, row.number("u"), row.number("v"));
    return {{"D", listed(at.D)},
            {"st", listed(at.st)},
            {"dD_u", listed(at.dD_du)},
            {"dst_u", {choice.width / choice.column_mass, 0}},
            {"dD_v", listed(at.dD_dv)},
            {"dst_v", {0, choice.width / choice.row_mass}},
            {"inv_pdf", listed(1 / at.pdf)},
            {"area", listed(area_of(at.dD_du, at.dD_dv))}};
}

NamedValues distance(const DifferentialCase& row) {
    const double sigma = row.number("sigma"), u = row.number("u");
    const FlightSample at = row.in.contains("tmax")
                                ? sample_bounded_distance(sigma, row.number("tmax"), u)
                                : sample_flight_distance(sigma, u);
    return {{"t", listed(at.t)},
            {"dt_u", listed(at.dt_du)},
            {"dt_sigma", listed(at.dt_dsigma)},
            {"dt_tmax", listed(at.dt_dlength)}};
}

/// Extinction a + k.x: the optical depth is a quadratic in t.
NamedValues distance_in_gradient(const DifferentialCase& row) {
    const glm::dvec3 P = row.vector("P"), D = row.vector("D"), k = row.vector("k");
    const glm::dvec3 dP = row.vector("dP"), dD = row.vector("dD");
    const double u = row.number("u"), start = row.number("a") + glm::dot(k, P);
    const double slope = glm::dot(k, D), depth = -std::log1p(-u);
    const double t = 2 * depth / (start + std::sqrt(start * start + 2 * slope * depth));
    const VariedFlight flight{start + slope * t, k * t, k * (t * t / 2)};
    const double dt_u = flight.own_change(u), dt_j = flight.change(dP, dD);
    return {{"t", listed(t)},
            {"P1", listed(P + t * D)},
            {"dt_u", listed(dt_u)},
            {"dP1_u", listed(transfer_in_volume(D, t, dt_u, glm::dvec3(0), glm::dvec3(0)))},
            {"dt_j", listed(dt_j)},
            {"dP1_j", listed(transfer_in_volume(D, t, dt_j, dP, dD))}};
}

NamedValues gradients(const DifferentialCase& row) {
    const glm::dvec3 N = row.vector("N"), R = row.vector("R"), D = row.vector("D");
    const glm::dvec3 dN = row.vector("dN"), dR = row.vector("dR"), dD = row.vector("dD");
    const double S = row.number("S"), g = row.number("g"), alpha = row.number("alpha");
    const double c = glm::dot(R, D), dc = glm::dot(dR, D) + glm::dot(R, dD);
    const double ln_hg =
        std::log((1 - g * g) / (4 * std::numbers::pi)) - 1.5 * std::log(1 + g * g - 2 * g * c);
    return {{"ln_cos", listed(std::log(glm::dot(N, D)))},
            {"ln_phong", listed(S * std::log(c))},
            {"ln_hg", listed(ln_hg)},
            {"ln_ggx", listed(tests::ln_microfacet<double>(N, R, D, alpha))},
            {"dln_cos_j", listed(dln_cosine(N, D, dN, dD))},
            {"dln_phong_j", listed(dln_power(R, D, S, dR, dD))},
            {"dln_hg_j", listed(dln_henyey_greenstein(g, c, dc))},
            {"dln_ggx_j", listed(dln_microfacet(N, dN, {R, D, dR, dD}, alpha))}};
}

NamedValues steps(const DifferentialCase& row) {
    return {{"local", listed(event_step(row.number("N")))},
            {"global", listed(global_step(row.number("N"), static_cast<int>(row.number("M")),
                                          row.number("survival")))}};
}

NamedValues footprint(const DifferentialCase& row) {
    std::vector<glm::dvec2> vectors;
    for (const auto& [name, value] : row.in) {
        vectors.push_back(row.pair(name));
    }
    const FootprintPair split = split_pair(vectors), best = best_pair(vectors);
    const PairExtent rms = pair_extent(rms_pair(vectors));
    return {{"area_polygon", listed(polygon_area(vectors))},
            {"area_split", listed(pair_area(split))},
            {"area_best", listed(pair_area(best))},
            {"A_len", listed(glm::length(split.A))},
            {"B_len", listed(glm::length(split.B))},
            {"rms_major", listed(rms.major)},
            {"rms_minor", listed(rms.minor)}};
}

NamedValues mip(const DifferentialCase& row) {
    const FootprintPair in_uv{row.pair("dA"), row.pair("dB")};
    const double resolution = row.number("res");
    UvMoments moments;
    moments.add(in_uv.A);
    moments.add(in_uv.B);
    const TextureTaps taps =
        texture_taps(moments, glm::dvec2(resolution), static_cast<int>(row.number("max_samples")));
    // The level of [Suykens2001], which overblurs skewed pairs: from the shorter vector.
    const double shorter = std::min(glm::length(in_uv.A), glm::length(in_uv.B));
    return {{"major_texels", listed(taps.major)},
            {"minor_texels", listed(taps.minor)},
            {"samples", listed(taps.count)},
            {"level", listed(taps.level)},
            {"level_paper", listed(std::log2(std::max(1.0, resolution * shorter)))}};
}

NamedValues chain(const DifferentialCase& row) {
    const tests::GlossyChain chain{row.vector("eye"), row.vector("center"), row.number("radius"),
                                   row.number("S"), row.number("floor_y")};
    const tests::ChainPoint at{row.number("x"), row.number("y"), row.number("u"), row.number("v")};
    return tests::chain_outputs(chain, at);
}

const std::map<std::string, std::function<NamedValues(const DifferentialCase&)>>& events() {
    static const std::map<std::string, std::function<NamedValues(const DifferentialCase&)>> all{
        {"pixel_pinhole", pixel},
        {"pixel_thinlens", lens},
        {"transfer_plane", transfer},
        {"transfer_sphere", transfer},
        {"reflect", reflection},
        {"refract", refraction},
        {"normal_interp", normal},
        {"frame_branchless", frame},
        {"lobe", lobe},
        {"hg", lobe},
        {"lobe_world", lobe_in_world},
        {"ggx_reflect", facet},
        {"ggx_refract", facet},
        {"triangle_sqrt", area_light},
        {"triangle_folded", area_light},
        {"rectangle", area_light},
        {"connect", connection},
        {"env_texel", texel},
        {"distance_exp", distance},
        {"distance_exp_bounded", distance},
        {"distance_linear", distance_in_gradient},
        {"log_gradient", gradients},
        {"delta", steps},
        {"footprint", footprint},
        {"mip", mip},
        {"chain_glossy_sphere", chain}};
    return all;
}

TEST(PathDifferentialTable, EveryRowIsReproduced) {
    OPALINE_NEEDS_REFERENCE("path-differentials.csv");
    const auto cases = tests::read_differential_cases();
    ASSERT_FALSE(cases.empty());
    for (const DifferentialCase& row : cases) {
        const auto found = events().find(row.event);
        ASSERT_TRUE(found != events().end()) << "no event " << row.event;
        tests::expect_outputs(row, found->second(row));
    }
}

}  // namespace
}  // namespace opaline::bake
