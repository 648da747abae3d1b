/* splash/splash_draw.c - what a view sees: selection and shading (prepare), pipelines for a target (attach), drawing. */
#include "splash/splash_internal.h"

virga_result virga_splash_prepare(virga_splash *splash, VkCommandBuffer cmd, const virga_view *view, double time_s)
{
    (void)cmd, (void)view, (void)time_s;
    return splash ? VIRGA_NOT_READY : VIRGA_ERROR_INVALID;
}

virga_result virga_splash_attach(virga_splash *splash, const virga_target *target)
{
    return splash && target ? VIRGA_OK : VIRGA_ERROR_INVALID;
}

virga_result virga_splash_draw(virga_splash *splash, VkCommandBuffer cmd, const virga_target *target)
{
    (void)cmd, (void)target;
    return splash ? VIRGA_NOT_READY : VIRGA_ERROR_INVALID;
}
