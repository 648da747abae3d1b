/* virga/virga.h - everything at once. */
#ifndef VIRGA_VIRGA_H
#define VIRGA_VIRGA_H
#include <virga/base.h>
#include <virga/contact.h>
#include <virga/drops.h>
#include <virga/environment.h>
#include <virga/fluid.h>
#include <virga/glass.h>
#include <virga/ground.h>
#include <virga/lens.h>
#include <virga/light.h>
#include <virga/material.h>
#include <virga/quality.h>
#include <virga/rain.h>
#include <virga/scene.h>
#include <virga/splash.h>
#include <virga/state.h>
#include <virga/vulkan.h>
#include <virga/walls.h>
#include <virga/water.h>
#include <virga/world.h>
#endif
