/* volume_module.h - what the module of OpenVDB gives to volume.c. */
#ifndef VIRGA_IO_VOLUME_MODULE_H
#define VIRGA_IO_VOLUME_MODULE_H

#include "volume.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The bytes of the file, to be freed by free(). `reason` gets one line without the path. */
typedef bool volume_encoder(const volume *v, void **data, size_t *size, char *reason, size_t reason_size);

#define VOLUME_ENCODE virga_volume_encode
extern volume_encoder VOLUME_ENCODE;

#ifdef __cplusplus
}
#endif
#endif
