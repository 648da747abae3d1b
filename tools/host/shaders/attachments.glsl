// attachments.glsl - what is drawn of the plate beside depth.

layout(location = 0) out vec4 out_color;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out vec2 out_velocity;
layout(location = 3) out vec2 out_water; // wetness, depth of water (m)
layout(location = 4) out uint out_id;
