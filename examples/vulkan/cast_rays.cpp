// Casts a million rays at a .vdag file on a graphics card, by Vulkan and shaders/voxdag.glsl or
// .hlsl, and compares each hit with that of voxdag_cast(): they are equal to the bit.
//
//   cast_rays SHADER.spv FILE.vdag [RAYS]
#include <vulkan/vulkan.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#define VOXDAG_IMPLEMENTATION
#include <voxdag.h>

namespace {

struct GpuRay {  // VoxdagRay of the shader
  float origin[3], t_min, inverse[3], t_max;
  std::uint32_t mirrored, parallel;
  float t_start, t_scale;
};
struct GpuHit {
  float t;
  std::int32_t voxel[3], face, is_hit, unused[2];
};

void check(VkResult result, const char* call) {
  if (result != VK_SUCCESS)
    throw std::runtime_error(std::string(call) + " failed: VkResult " + std::to_string(result));
}
#define VK(call) check(call, #call)

std::vector<char> read_file(const char* path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(std::string(path) + ": cannot open");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A device with a queue for compute, and buffers that both it and the program see.
struct Gpu {
  VkInstance instance{};
  VkPhysicalDevice physical{};
  VkDevice device{};
  std::uint32_t family = 0;
  VkQueue queue{};
  VkPhysicalDeviceProperties properties{};

  Gpu() {
    const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                        .apiVersion = VK_API_VERSION_1_1};
    const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                    .pApplicationInfo = &application};
    VK(vkCreateInstance(&info, nullptr, &instance));
    std::uint32_t count = 1;
    vkEnumeratePhysicalDevices(instance, &count, &physical);
    if (count == 0) throw std::runtime_error("no Vulkan device");
    vkGetPhysicalDeviceProperties(physical, &properties);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    while (family < count && !(families[family].queueFlags & VK_QUEUE_COMPUTE_BIT)) ++family;
    if (family == count) throw std::runtime_error("the Vulkan device has no queue for compute");
    const float priority = 1;
    const VkDeviceQueueCreateInfo queues{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                         .queueFamilyIndex = family,
                                         .queueCount = 1,
                                         .pQueuePriorities = &priority};
    const VkDeviceCreateInfo device_info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                         .queueCreateInfoCount = 1,
                                         .pQueueCreateInfos = &queues};
    VK(vkCreateDevice(physical, &device_info, nullptr, &device));
    vkGetDeviceQueue(device, family, 0, &queue);
  }
  ~Gpu() {
    vkDestroyDevice(device, nullptr);
    vkDestroyInstance(instance, nullptr);
  }
};

/// A storage buffer in memory that the program maps.
struct Buffer {
  VkDevice device;
  VkBuffer buffer{};
  VkDeviceMemory memory{};
  void* data = nullptr;

  /// `bytes` may be null: the device will write them.
  Buffer(const Gpu& gpu, std::size_t size, const void* bytes) : device(gpu.device) {
    if (size > gpu.properties.limits.maxStorageBufferRange)
      throw std::runtime_error("the device has no buffers of this size");
    const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                  .size = size,
                                  .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
    VK(vkCreateBuffer(device, &info, nullptr, &buffer));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device, buffer, &needs);
    VkPhysicalDeviceMemoryProperties types;
    vkGetPhysicalDeviceMemoryProperties(gpu.physical, &types);
    constexpr VkMemoryPropertyFlags wanted =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    std::uint32_t type = 0;
    while (!(needs.memoryTypeBits >> type & 1 &&
             (types.memoryTypes[type].propertyFlags & wanted) == wanted))
      ++type;
    const VkMemoryAllocateInfo allocation{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                          .allocationSize = needs.size,
                                          .memoryTypeIndex = type};
    VK(vkAllocateMemory(device, &allocation, nullptr, &memory));
    VK(vkBindBufferMemory(device, buffer, memory, 0));
    VK(vkMapMemory(device, memory, 0, size, 0, &data));
    if (bytes != nullptr) std::memcpy(data, bytes, size);
  }
  Buffer(const Buffer&) = delete;
  ~Buffer() {
    vkDestroyBuffer(device, buffer, nullptr);
    vkFreeMemory(device, memory, nullptr);
  }
};

/// Runs the shader, which has the levels as constant 0 and the buffers at bindings 0 to 3, for
/// `count` rays.
void dispatch(const Gpu& gpu, const std::vector<char>& spirv, std::int32_t levels,
              const Buffer* const (&buffers)[4], std::uint32_t count) {
  VkDescriptorSetLayoutBinding bindings[4];
  for (std::uint32_t i = 0; i < 4; ++i)
    bindings[i] = {.binding = i,
                   .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                   .descriptorCount = 1,
                   .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
  const VkDescriptorSetLayoutCreateInfo set_info{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
      .bindingCount = 4,
      .pBindings = bindings};
  VkDescriptorSetLayout set_layout;
  VK(vkCreateDescriptorSetLayout(gpu.device, &set_info, nullptr, &set_layout));
  const VkPipelineLayoutCreateInfo layout_info{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
      .setLayoutCount = 1,
      .pSetLayouts = &set_layout};
  VkPipelineLayout layout;
  VK(vkCreatePipelineLayout(gpu.device, &layout_info, nullptr, &layout));
  const VkShaderModuleCreateInfo module_info{
      .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
      .codeSize = spirv.size(),
      .pCode = reinterpret_cast<const std::uint32_t*>(spirv.data())};
  VkShaderModule module;
  VK(vkCreateShaderModule(gpu.device, &module_info, nullptr, &module));
  const VkSpecializationMapEntry entry{.constantID = 0, .offset = 0, .size = sizeof levels};
  const VkSpecializationInfo constants{
      .mapEntryCount = 1, .pMapEntries = &entry, .dataSize = sizeof levels, .pData = &levels};
  const VkComputePipelineCreateInfo pipeline_info{
      .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
      .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                .module = module,
                .pName = "main",
                .pSpecializationInfo = &constants},
      .layout = layout};
  VkPipeline pipeline;
  VK(vkCreateComputePipelines(gpu.device, VK_NULL_HANDLE, 1, &pipeline_info, nullptr, &pipeline));

  const VkDescriptorPoolSize pool_size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 4};
  const VkDescriptorPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = 1,
                                             .pPoolSizes = &pool_size};
  VkDescriptorPool pool;
  VK(vkCreateDescriptorPool(gpu.device, &pool_info, nullptr, &pool));
  const VkDescriptorSetAllocateInfo set_allocation{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
      .descriptorPool = pool,
      .descriptorSetCount = 1,
      .pSetLayouts = &set_layout};
  VkDescriptorSet set;
  VK(vkAllocateDescriptorSets(gpu.device, &set_allocation, &set));
  for (std::uint32_t i = 0; i < 4; ++i) {
    const VkDescriptorBufferInfo whole{buffers[i]->buffer, 0, VK_WHOLE_SIZE};
    const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                     .dstSet = set,
                                     .dstBinding = i,
                                     .descriptorCount = 1,
                                     .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                     .pBufferInfo = &whole};
    vkUpdateDescriptorSets(gpu.device, 1, &write, 0, nullptr);
  }

  const VkCommandPoolCreateInfo commands_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                              .queueFamilyIndex = gpu.family};
  VkCommandPool commands;
  VK(vkCreateCommandPool(gpu.device, &commands_info, nullptr, &commands));
  const VkCommandBufferAllocateInfo command_info{
      .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
      .commandPool = commands,
      .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
      .commandBufferCount = 1};
  VkCommandBuffer command;
  VK(vkAllocateCommandBuffers(gpu.device, &command_info, &command));
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  VK(vkBeginCommandBuffer(command, &begin));
  vkCmdBindPipeline(command, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  vkCmdBindDescriptorSets(command, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
  vkCmdDispatch(command, (count + 63) / 64, 1, 1);
  VK(vkEndCommandBuffer(command));
  const VkSubmitInfo submit{
      .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &command};
  VK(vkQueueSubmit(gpu.queue, 1, &submit, VK_NULL_HANDLE));
  VK(vkQueueWaitIdle(gpu.queue));

  vkDestroyCommandPool(gpu.device, commands, nullptr);
  vkDestroyDescriptorPool(gpu.device, pool, nullptr);
  vkDestroyPipeline(gpu.device, pipeline, nullptr);
  vkDestroyShaderModule(gpu.device, module, nullptr);
  vkDestroyPipelineLayout(gpu.device, layout, nullptr);
  vkDestroyDescriptorSetLayout(gpu.device, set_layout, nullptr);
}

/// Returns rays from all around the grid, and from inside, through random points of it.
std::vector<voxdag_ray> random_rays(const voxdag_info& info, std::size_t count) {
  std::mt19937 random(1);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  const double side = info.voxel_size * info.resolution;
  std::vector<voxdag_ray> rays(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double to = uniform(), from = i % 2 == 0 ? uniform() : 3 * uniform() - 1;
      rays[i].origin[axis] = info.origin[axis] + side * from;
      rays[i].direction[axis] = side * (to - from);
    }
    if (i % 16 == 0) rays[i].direction[i / 16 % 3] = 0;
    rays[i].t_max = i % 5 == 0 ? 0.5f : INFINITY;
  }
  return rays;
}

int run(const char* shader, const char* file, std::size_t count) {
  const std::vector<char> spirv = read_file(shader), bytes = read_file(file);
  std::vector<char> scratch(VOXDAG_SCRATCH_BYTES(bytes.size()));
  voxdag_scene scene;
  if (const char* error =
          voxdag_open(&scene, bytes.data(), bytes.size(), scratch.data(), scratch.size()))
    throw std::runtime_error(std::string(file) + ": " + error);

  // A ray that misses the grid stays as it is: t_max < t_min.
  const std::vector<voxdag_ray> rays = random_rays(scene.info, count);
  std::vector<voxdag_grid_ray> grid_rays(count);
  std::vector<GpuRay> gpu_rays(count, GpuRay{.t_min = 1});
  for (std::size_t i = 0; i < count; ++i)
    if (voxdag_enter_grid(&scene, &rays[i], &grid_rays[i]))
      std::memcpy(&gpu_rays[i], &grid_rays[i], offsetof(GpuRay, t_start));

  const Gpu gpu;
  const std::uint64_t words = scene.level_begin[scene.info.levels - 2];
  const std::uint32_t nothing[2] = {};  // buffers may not be empty
  const Buffer nodes(gpu, words > 0 ? words * 4 : 4,
                     words > 0 ? static_cast<const void*>(scene.nodes) : nothing);
  const Buffer leaves(gpu, scene.leaf_count > 0 ? scene.leaf_count * 8 : 8,
                      scene.leaf_count > 0 ? static_cast<const void*>(scene.leaves) : nothing);
  const Buffer ray_buffer(gpu, count * sizeof(GpuRay), gpu_rays.data()),
      hit_buffer(gpu, count * sizeof(GpuHit), nullptr);
  const std::int32_t levels = scene.leaf_count > 0 ? scene.info.levels : 0;
  dispatch(gpu, spirv, levels, {&nodes, &leaves, &ray_buffer, &hit_buffer},
           static_cast<std::uint32_t>(count));

  std::size_t hits = 0, differ = 0;
  const auto* const found = static_cast<const GpuHit*>(hit_buffer.data);
  for (std::size_t i = 0; i < count; ++i) {
    voxdag_hit expected;
    const int is_hit = voxdag_cast(&scene, &rays[i], &expected);
    hits += is_hit != 0;
    if (is_hit != found[i].is_hit) {
      ++differ;
    } else if (is_hit) {
      const float t = static_cast<float>(
          std::fma(static_cast<double>(found[i].t), grid_rays[i].t_scale, grid_rays[i].t_start));
      differ += std::memcmp(expected.voxel, found[i].voxel, sizeof expected.voxel) != 0 ||
                expected.face != found[i].face ||
                expected.t != std::fmax(rays[i].t_min, std::fmin(t, rays[i].t_max));
    }
  }
  std::printf("%s: %zu rays, %zu hits, %zu differ from voxdag_cast()\n", gpu.properties.deviceName,
              count, hits, differ);
  return differ == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 3) return std::fprintf(stderr, "usage: %s SHADER.spv FILE.vdag [RAYS]\n", argv[0]), 2;
  return run(argv[1], argv[2], argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 1'000'000);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
