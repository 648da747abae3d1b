/* light_limits.h - limits that C and GLSL share wherever water is lit. */
#ifndef VIRGA_SHARED_LIGHT_LIMITS_H
#define VIRGA_SHARED_LIGHT_LIMITS_H

#define VIRGA_MAX_LIGHTS 16

#endif
