// write_seeds FOLDER: for each target a folder of its name with small sound files.
#include <filesystem>
#include <fstream>

#include "tests/fuzz/seeds.h"
#include "tests/fuzz/targets.h"

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    for (const opaline::fuzz::Target& target : opaline::fuzz::all_targets()) {
        const auto folder = std::filesystem::path(argv[1]) / target.name;
        std::filesystem::create_directories(folder);
        std::size_t number = 0;
        for (const std::string& seed : opaline::fuzz::make_seeds(target.name)) {
            std::ofstream(folder / ("seed-" + std::to_string(number++)), std::ios::binary) << seed;
        }
    }
}
