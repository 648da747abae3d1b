/* light_limits.h - sizes that C and GLSL agree on wherever water is lit. */
#ifndef VIRGA_SHARED_LIGHT_LIMITS_H
#define VIRGA_SHARED_LIGHT_LIMITS_H

#define VIRGA_MAX_LIGHTS 16

#endif
