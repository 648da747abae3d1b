// reuse_contrast.glsl - how much two pixels differ.

// As a share of the brighter one, of the color that differs most. What is dark beside white under this sky counts as a
// bit brighter: nobody sees by how many times it differs, and dark, rough ground would be shaded in each sub-frame.
float reuse_contrast(vec3 a, vec3 b)
{
    const vec3 apart = abs(a - b), most = max(a, b);
    return max(apart.r, max(apart.g, apart.b)) / max(max(most.r, max(most.g, most.b)), reuse.dark);
}
