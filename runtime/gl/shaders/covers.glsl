// Whether a sample sees a surface of that alpha, as sees_surface of runtime/surface.cpp.
// `cutoff_mode`: cutoff, 1: a mask, 2: a blend, whose samples are spread evenly over any part of the
// picture, shifted by `triangle`, so that surfaces behind each other need no sorting.
bool covers(float alpha, vec2 cutoff_mode, uvec2 at, uint triangle) {
    if (cutoff_mode.y == 1.0) return alpha >= cutoff_mode.x;
    uint place = 0xc13fa9a9u * at.x + 0x91e10da6u * at.y + 0x9e3779b9u * triangle;
    return float(place >> 8) < alpha * 16777216.0;
}
