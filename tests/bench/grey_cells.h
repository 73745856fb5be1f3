#pragma once

#include <cmath>
#include <cstdio>
#include <string>

#include "formats/gltf/import_gltf.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A grey medium of index 1.4, Henyey-Greenstein: a cell of a table of RESULTS.md.
struct GreyCell {
    /// Transport mean free path without absorption in percent of the diagonal; albedo; mean cosine.
    float length = 0, albedo = 0, cosine = 0;
};

/// Fills all materials of a scene.
inline void fill_scene(formats::Scene& scene, const GreyCell& cell) {
    glm::vec3 low(HUGE_VALF), high(-HUGE_VALF);
    for (const formats::Primitive& p : scene.primitives) {
        for (const glm::vec3& x : p.position) {
            low = glm::min(low, x);
            high = glm::max(high, x);
        }
    }
    const float reduced = 100 / (cell.length * glm::length(high - low));
    formats::Medium medium;
    const float sigma_s = reduced / (1 - cell.cosine);
    const float sigma_a = sigma_s * (1 - cell.albedo) / cell.albedo;
    medium.sigma_s = {sigma_s, sigma_s, sigma_s};
    medium.sigma_a = {sigma_a, sigma_a, sigma_a};
    medium.eta = 1.4f;
    if (cell.cosine != 0) {
        medium.phase.type = formats::PhaseFunction::Type::henyey_greenstein;
        medium.phase.g = cell.cosine;
    }
    for (auto& material : scene.materials) {
        material.medium = medium;
    }
}

/// For each LENGTH,ALBEDO,G after the scene's file among a program's arguments, prints the start of
/// a row and calls print_cell(filled scene). Returns the exit code.
template <class Print>
int print_grey_cells(int count, char** argument, Print&& print_cell) {
    if (count < 3) {
        std::fprintf(stderr, "usage: %s SCENE LENGTH,ALBEDO,G...\n", argument[0]);
        return 2;
    }
    const std::string file = argument[1];
    auto imported = formats::import_gltf(file);
    if (!imported) {
        std::fprintf(stderr, "cannot read %s\n", file.c_str());
        return 1;
    }
    for (int i = 2; i < count; ++i) {
        const char* const text = argument[i];
        GreyCell cell;
        if (std::sscanf(text, "%f,%f,%f", &cell.length, &cell.albedo, &cell.cosine) != 3) {
            std::fprintf(stderr, "not LENGTH,ALBEDO,G: %s\n", text);
            return 2;
        }
        fill_scene(imported->scene, cell);
        std::printf("| %s | %s |", file.c_str(), text);
        print_cell(imported->scene);
        std::fflush(stdout);
    }
    return 0;
}

}  // namespace opaline::bake
