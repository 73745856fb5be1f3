#pragma once

namespace opaline::tests {

/// The tables and figures of opaline_bench, each run with the arguments after its name. Exit code.
int brute_force_table(int count, char** arguments);
int error_matrix(int count, char** arguments);
int interreflection_table(int count, char** arguments);
int model_table(int count, char** arguments);
int radiosity_figure(int count, char** arguments);
int slab_accuracy(int count, char** arguments);
int texture_filter(int count, char** arguments);
int volume_relight(int count, char** arguments);
int walk_table(int count, char** arguments);
int write_cloud(int count, char** arguments);

}  // namespace opaline::tests
