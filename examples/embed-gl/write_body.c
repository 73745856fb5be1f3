/* The body as a scene to bake, its vertices in the program's own order:
       write_body FOLDER && opaline bake FOLDER/body.gltf -o body.opal --media jade.json       */
#include "host.h"

int main(int argc, char** argv) {
    static vertex vertices[VERTICES];
    static unsigned indices[INDICES];
    char path[1000];
    make_body(vertices, indices);
    if (argc < 2) return 2;
    snprintf(path, sizeof path, "%s/body.bin", argv[1]);
    FILE* file = fopen(path, "wb");
    if (file == NULL || fwrite(vertices, sizeof vertices, 1, file) != 1 ||
        fwrite(indices, sizeof indices, 1, file) != 1 || fclose(file) != 0) {
        return 1;
    }
    float low[3], high[3];
    for (int k = 0; k < 3; ++k) {
        low[k] = high[k] = vertices[0].position[k];
        for (int i = 0; i < VERTICES; ++i) {
            low[k] = fminf(low[k], vertices[i].position[k]);
            high[k] = fmaxf(high[k], vertices[i].position[k]);
        }
    }
    snprintf(path, sizeof path, "%s/body.gltf", argv[1]);
    file = fopen(path, "w");
    if (file == NULL) return 1;
    fprintf(
        file,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
        "\"nodes\":[{\"name\":\"Body\",\"mesh\":0}],\"materials\":[{\"name\":\"Body\","
        "\"pbrMetallicRoughness\":{\"metallicFactor\":0}}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},"
        "\"indices\":2,\"material\":0}]}],\"buffers\":[{\"uri\":\"body.bin\",\"byteLength\":%zu}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu,\"byteStride\":24},"
        "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}],\"accessors\":["
        "{\"bufferView\":0,\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\","
        "\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]},"
        "{\"bufferView\":0,\"byteOffset\":12,\"componentType\":5126,\"count\":%d,"
        "\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5125,\"count\":%d,\"type\":\"SCALAR\"}]}\n",
        sizeof vertices + sizeof indices, sizeof vertices, sizeof vertices, sizeof indices,
        VERTICES, low[0], low[1], low[2], high[0], high[1], high[2], VERTICES, INDICES);
    return fclose(file) == 0 ? 0 : 1;
}
