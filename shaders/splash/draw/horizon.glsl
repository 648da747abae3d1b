// horizon.glsl - how much of the environment is seen in a direction: surroundings hide it below, at, and somewhat above
// the horizon.
float open_share(vec3 direction) { return smoothstep(-0.2, 0.4, direction.y); }
