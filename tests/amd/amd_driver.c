#include "amd_driver.h"

#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static amd_driver *opened;
static amd_table *table_of_statistics;

/* ---- pipelines: statistics are asked for when they are created, and read when they get their names */

#define CREATE_WITH_STATISTICS(Type)                                                                                   \
    static VKAPI_ATTR VkResult VKAPI_CALL create_##Type(VkDevice device, VkPipelineCache cache, uint32_t count,        \
                                                        const Vk##Type##PipelineCreateInfo *infos,                     \
                                                        const VkAllocationCallbacks *allocator, VkPipeline *pipelines) \
    {                                                                                                                  \
        const PFN_vkCreate##Type##Pipelines create =                                                                   \
            (PFN_vkCreate##Type##Pipelines)vkGetDeviceProcAddr(device, "vkCreate" #Type "Pipelines");                  \
        VkResult result = VK_SUCCESS;                                                                                  \
        for (uint32_t i = 0; i < count && !result; i++) {                                                              \
            Vk##Type##PipelineCreateInfo info = infos[i];                                                              \
            info.flags |= VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;                                               \
            result = create(device, cache, 1, &info, allocator, &pipelines[i]);                                        \
        }                                                                                                              \
        return result;                                                                                                 \
    }
CREATE_WITH_STATISTICS(Compute)
CREATE_WITH_STATISTICS(Graphics)

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_of_device(VkDevice device, const char *name)
{
    (void)device;
    return amd_driver_get(NULL, name);
}

PFN_vkVoidFunction VKAPI_CALL amd_driver_get(VkInstance instance, const char *name)
{
    if (!strcmp(name, "vkGetDeviceProcAddr"))
        return (PFN_vkVoidFunction)get_of_device;
    if (!strcmp(name, "vkCreateComputePipelines"))
        return (PFN_vkVoidFunction)create_Compute;
    if (!strcmp(name, "vkCreateGraphicsPipelines"))
        return (PFN_vkVoidFunction)create_Graphics;
    return stand_in_get(instance, name);
}

/* Names of the driver's statistics. Spills of both kinds of registers are added up. */
static void add_figure(double figures[AMD_FIGURES], const char *name, double value)
{
    static const struct {
        const char *name;
        amd_figure figure;
    } names[] = {{"VGPRs", AMD_VGPRS},
                 {"SGPRs", AMD_SGPRS},
                 {"LDS size", AMD_LDS_BYTES},
                 {"Subgroups per SIMD", AMD_WAVES_PER_SIMD},
                 {"Latency", AMD_LATENCY},
                 {"Inverse Throughput", AMD_INVERSE_THROUGHPUT},
                 {"Spilled SGPRs", AMD_SPILLED_REGISTERS},
                 {"Spilled VGPRs", AMD_SPILLED_REGISTERS},
                 {"Scratch size", AMD_SCRATCH_BYTES}};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (!strcmp(names[i].name, name))
            figures[names[i].figure] += value;
}

static double value_of(const VkPipelineExecutableStatisticKHR *statistic)
{
    switch (statistic->format) {
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR: return (double)statistic->value.i64;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR: return (double)statistic->value.u64;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_FLOAT64_KHR: return statistic->value.f64;
    default: return 0;
    }
}

static const char *stage_name(VkShaderStageFlags stages)
{
    return stages & VK_SHADER_STAGE_COMPUTE_BIT    ? "compute"
           : stages & VK_SHADER_STAGE_FRAGMENT_BIT ? "fragment"
           : stages & VK_SHADER_STAGE_GEOMETRY_BIT ? "geometry"
                                                   : "vertex";
}

static void read_statistics(VkPipeline pipeline, uint32_t stage, VkShaderStageFlags stages, const char *pass)
{
    enum { MAX_STATISTICS = 64 };
    static PFN_vkGetPipelineExecutableStatisticsKHR get;
    const VkPipelineExecutableInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, .pipeline = pipeline, .executableIndex = stage};
    VkPipelineExecutableStatisticKHR statistics[MAX_STATISTICS];
    uint32_t count = MAX_STATISTICS;
    double figures[AMD_FIGURES] = {0};
    memset(statistics, 0, sizeof statistics);
    for (int i = 0; i < MAX_STATISTICS; i++)
        statistics[i].sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR;
    if (!get)
        get = (PFN_vkGetPipelineExecutableStatisticsKHR)vkGetDeviceProcAddr(opened->device,
                                                                            "vkGetPipelineExecutableStatisticsKHR");
    get(opened->device, &info, &count, statistics);
    for (uint32_t i = 0; i < count; i++)
        add_figure(figures, statistics[i].name, value_of(&statistics[i]));
    amd_table_add(table_of_statistics, pass, stage_name(stages), figures);
}

static void read_pipeline(VkObjectType type, uint64_t object, const char *name)
{
    enum { MAX_STAGES = 4 };
    static PFN_vkGetPipelineExecutablePropertiesKHR get;
    const VkPipelineInfoKHR info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR, .pipeline = (VkPipeline)object};
    VkPipelineExecutablePropertiesKHR stages[MAX_STAGES];
    uint32_t count = MAX_STAGES;
    if (type != VK_OBJECT_TYPE_PIPELINE)
        return;
    memset(stages, 0, sizeof stages);
    for (int i = 0; i < MAX_STAGES; i++)
        stages[i].sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR;
    if (!get)
        get = (PFN_vkGetPipelineExecutablePropertiesKHR)vkGetDeviceProcAddr(opened->device,
                                                                            "vkGetPipelineExecutablePropertiesKHR");
    get(opened->device, &info, &count, stages);
    for (uint32_t i = 0; i < count; i++)
        read_statistics(info.pipeline, i, stages[i].stages, name);
}

/* ---- the device */

/* The loader is to see this driver alone: others have no null device, and would be asked first. */
static bool choose_driver(const char *card)
{
    static const char *const patterns[] = {"/usr/share/vulkan/icd.d/radeon_icd*.json",
                                           "/etc/vulkan/icd.d/radeon_icd*.json",
                                           "/usr/local/share/vulkan/icd.d/radeon_icd*.json"};
    glob_t found = {0};
    for (size_t i = 0; i < sizeof patterns / sizeof patterns[0]; i++)
        glob(patterns[i], i ? GLOB_APPEND : 0, NULL, &found);
    const bool is_there = found.gl_pathc > 0;
    if (is_there) {
        setenv("VK_ICD_FILENAMES", found.gl_pathv[0], 1);
        setenv("VK_DRIVER_FILES", found.gl_pathv[0], 1);
        setenv("VK_LOADER_LAYERS_DISABLE", "*", 1);
        setenv("RADV_FORCE_FAMILY", card, 1);
    }
    globfree(&found);
    return is_there;
}

static const char *open_device(amd_driver *driver)
{
    static const char *const extensions[] = {"VK_KHR_pipeline_executable_properties"};
    const float priority = 1;
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR,
        .pipelineExecutableInfo = VK_TRUE};
    VkPhysicalDeviceVulkan13Features of_1_3 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                               .pNext = &statistics,
                                               .dynamicRendering = VK_TRUE};
    VkPhysicalDeviceVulkan12Features of_1_2 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
                                               .pNext = &of_1_3,
                                               .scalarBlockLayout = VK_TRUE,
                                               .timelineSemaphore = VK_TRUE,
                                               .hostQueryReset = VK_TRUE};
    VkPhysicalDeviceVulkan11Features of_1_1 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES, .pNext = &of_1_2, .multiview = VK_TRUE};
    const VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                                .pNext = &of_1_1,
                                                .features = {.independentBlend = VK_TRUE, .wideLines = VK_TRUE}};
    const VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
    const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .pNext = &features,
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queue,
                                     .enabledExtensionCount = 1,
                                     .ppEnabledExtensionNames = extensions};
    return vkCreateDevice(driver->physical, &info, NULL, &driver->device) ? "its device can not be created" : NULL;
}

static const char *open_instance(amd_driver *driver)
{
    const VkApplicationInfo app = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &app};
    VkPhysicalDeviceDriverProperties of_driver = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                              .pNext = &of_driver};
    uint32_t count = 1;
    if (vkCreateInstance(&info, NULL, &driver->instance))
        return "Mesa's driver for AMD makes no instance";
    if (vkEnumeratePhysicalDevices(driver->instance, &count, &driver->physical) < 0 || !count)
        return "Mesa's driver for AMD has no null device of this card";
    vkGetPhysicalDeviceProperties2(driver->physical, &properties);
    if (properties.properties.vendorID != 0x1002)
        return "the null device is not of AMD";
    snprintf(driver->name, sizeof driver->name, "%.127s, %.63s", properties.properties.deviceName,
             of_driver.driverInfo);
    return NULL;
}

const char *amd_driver_open(amd_driver *driver, const char *card, amd_table *table)
{
    if (!choose_driver(card))
        return "Mesa's driver for AMD is not installed (Debian: mesa-vulkan-drivers)";
    const char *missing = open_instance(driver);
    if (!missing)
        missing = open_device(driver);
    if (missing)
        return missing;
    opened = driver;
    table_of_statistics = table;
    driver->create_render_pass = vkCreateRenderPass;
    driver->destroy_render_pass = vkDestroyRenderPass;
    stand_in.through = vkGetInstanceProcAddr;
    stand_in.instance = driver->instance;
    stand_in.physical = driver->physical;
    stand_in.device = driver->device;
    stand_in.named = read_pipeline;
    return NULL;
}

void amd_driver_close(amd_driver *driver)
{
    vkDestroyDevice(driver->device, NULL);
    vkDestroyInstance(driver->instance, NULL);
}
