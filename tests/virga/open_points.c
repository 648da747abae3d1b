/* open_points.c - opens a point cache with a reader that is not ours: prints how many points it finds, and the first
 * and the last of them. */
#include <assimp/cimport.h>
#include <assimp/scene.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    const struct aiScene *scene = argc == 2 ? aiImportFile(argv[1], 0) : NULL;
    if (!scene || scene->mNumMeshes != 1 || !scene->mMeshes[0]->mNumVertices) {
        fprintf(stderr, "%s: %s\n", argc == 2 ? argv[1] : "expected one file",
                scene ? "no points" : aiGetErrorString());
        return 1;
    }
    const struct aiMesh *mesh = scene->mMeshes[0];
    const struct aiVector3D *first = &mesh->mVertices[0], *last = &mesh->mVertices[mesh->mNumVertices - 1];
    printf("%u %.9g %.9g %.9g %.9g %.9g %.9g\n", mesh->mNumVertices, (double)first->x, (double)first->y,
           (double)first->z, (double)last->x, (double)last->y, (double)last->z);
    aiReleaseImport(scene);
    return 0;
}
