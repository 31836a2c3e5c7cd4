// A kernel driver "amdgpu" that executes nothing, for Mesa's drm-shim. It describes one GPU, hands out memory and
// ignores commands. So radeonsi compiles shaders on a machine without an AMD GPU. AMDGPU_SHIM_CHIP names the GPU:
// navi10 or gfx1100. Mesa 22.3 has such a library for Intel's GPUs, and for AMD's only for the older kernel driver
// radeon.
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drm-shim/drm_shim.h"
#include "drm-uapi/amdgpu_drm.h"

bool drm_shim_driver_prefers_first_render_node = true;

struct chip
{
  const char* name;
  unsigned device_id, family, revision;  // family and revision as in addrlib/src/amdgpu_asic_addr.h
  unsigned generation;                   // of the graphics block
  unsigned shader_engines, units;        // compute units of each of the two arrays of an engine
  unsigned render_backends, cache_blocks;
  unsigned address_config;  // the register GB_ADDR_CONFIG
};

static const struct chip chips[] = {{"navi10", 0x731f, 0x8f, 0x01, 10, 2, 10, 16, 16, 0x00100044},
                                    {"gfx1100", 0x744c, 0x91, 0x01, 11, 6, 8, 24, 24, 0x00000545}};
static const struct chip* chip = chips;

static void describe_device(struct drm_amdgpu_info_device* info)
{
  info->device_id = chip->device_id;
  info->external_rev = chip->revision;
  info->family = chip->family;
  info->num_shader_engines = chip->shader_engines;
  info->num_shader_arrays_per_engine = 2;
  info->gpu_counter_freq = 100000;
  info->max_engine_clock = 2000000;
  info->max_memory_clock = 1000000;
  info->cu_active_number = chip->shader_engines * 2 * chip->units;
  for (unsigned engine = 0; engine < chip->shader_engines; ++engine)
    for (unsigned array = 0; array < 2; ++array)
      info->cu_bitmap[engine % 4][engine / 4 * 2 + array] = (1u << chip->units) - 1;
  info->enabled_rb_pipes_mask = (1u << chip->render_backends) - 1;
  info->num_rb_pipes = chip->render_backends;
  info->num_hw_gfx_contexts = 8;
  info->virtual_address_offset = 0x200000;
  info->virtual_address_max = 0x800000000000;
  info->virtual_address_alignment = 4096;
  info->pte_fragment_size = 0x200000;
  info->gart_page_size = 4096;
  info->vram_type = AMDGPU_VRAM_TYPE_GDDR6;
  info->vram_bit_width = 256;
  info->wave_front_size = 32;
  info->num_shader_visible_vgprs = 256;
  info->num_cu_per_sh = chip->units;
  info->num_tcc_blocks = chip->cache_blocks;
  info->gs_vgt_table_depth = 32;
  info->gs_prim_buffer_depth = 1792;
  info->max_gs_waves_per_vgt = 32;
  info->high_va_offset = 0xffff800000200000;
  info->high_va_max = 0xffffffffffe00000;
}

static void describe_memory(struct drm_amdgpu_memory_info* info)
{
  const unsigned long long size = 2ull << 30;
  struct drm_amdgpu_heap_info* const heaps[] = {&info->vram, &info->cpu_accessible_vram, &info->gtt};
  for (unsigned i = 0; i < 3; ++i)
    heaps[i]->total_heap_size = heaps[i]->usable_heap_size = heaps[i]->max_allocation = size;
}

static int get_info(int fd, unsigned long request, void* arg)
{
  const struct drm_amdgpu_info* const query = arg;
  // Large enough for each answer; the caller gets as many bytes as it asked for.
  union
  {
    unsigned words[256];
    struct drm_amdgpu_info_device device;
    struct drm_amdgpu_memory_info memory;
    struct drm_amdgpu_info_hw_ip block;
    struct drm_amdgpu_info_firmware firmware;
  } answer = {{0}};
  if (query->return_size > sizeof(answer))
    return -EINVAL;
  switch (query->query)
  {
    case AMDGPU_INFO_ACCEL_WORKING:
      answer.words[0] = 1;
      break;
    case AMDGPU_INFO_DEV_INFO:
      describe_device(&answer.device);
      break;
    case AMDGPU_INFO_MEMORY:
      describe_memory(&answer.memory);
      break;
    case AMDGPU_INFO_HW_IP_INFO:
      if (query->query_hw_ip.type <= AMDGPU_HW_IP_DMA)
      {
        answer.block.hw_ip_version_major = chip->generation;
        answer.block.ib_start_alignment = 32;
        answer.block.ib_size_alignment = 32;
        answer.block.available_rings = 1;
      }
      break;
    case AMDGPU_INFO_FW_VERSION:
      answer.firmware.ver = 100;
      answer.firmware.feature = 50;
      break;
    case AMDGPU_INFO_READ_MMR_REG:
      for (unsigned i = 0; i < query->read_mmr_reg.count; ++i)
        answer.words[i] = chip->address_config;
      break;
    default:  // zeros
      break;
  }
  memcpy((void*)(size_t)query->return_pointer, &answer, query->return_size);
  return 0;
}

static int create_buffer(int fd, unsigned long request, void* arg)
{
  union drm_amdgpu_gem_create* const create = arg;
  struct shim_bo* const buffer = calloc(1, sizeof(*buffer));
  const int error = drm_shim_bo_init(buffer, (create->in.bo_size + 4095) & ~4095ull);
  if (error)
  {
    free(buffer);
    return error;
  }
  const int handle = drm_shim_bo_get_handle(drm_shim_fd_lookup(fd), buffer);
  memset(create, 0, sizeof(*create));
  create->out.handle = handle;
  drm_shim_bo_put(buffer);
  return 0;
}

static int map_buffer(int fd, unsigned long request, void* arg)
{
  union drm_amdgpu_gem_mmap* const map = arg;
  struct shim_fd* const device = drm_shim_fd_lookup(fd);
  struct shim_bo* const buffer = drm_shim_bo_lookup(device, map->in.handle);
  if (!buffer)
    return -EINVAL;
  map->out.addr_ptr = drm_shim_bo_get_mmap_offset(device, buffer);
  drm_shim_bo_put(buffer);
  return 0;
}

static int create_context(int fd, unsigned long request, void* arg)
{
  union drm_amdgpu_ctx* const context = arg;
  memset(context, 0, sizeof(*context));
  context->out.alloc.ctx_id = 1;
  return 0;
}

// Answers that all work is done.
static int wait_for_commands(int fd, unsigned long request, void* arg)
{
  memset(arg, 0, sizeof(union drm_amdgpu_wait_cs));
  return 0;
}

static int wait_for_buffer(int fd, unsigned long request, void* arg)
{
  memset(arg, 0, sizeof(union drm_amdgpu_gem_wait_idle));
  return 0;
}

static int refuse(int fd, unsigned long request, void* arg)
{
  return -EINVAL;
}

static int do_nothing(int fd, unsigned long request, void* arg)
{
  return 0;
}

static ioctl_fn_t ioctls[] = {
    [DRM_AMDGPU_GEM_CREATE] = create_buffer,
    [DRM_AMDGPU_GEM_MMAP] = map_buffer,
    [DRM_AMDGPU_CTX] = create_context,
    [DRM_AMDGPU_BO_LIST] = do_nothing,
    [DRM_AMDGPU_CS] = do_nothing,
    [DRM_AMDGPU_INFO] = get_info,
    [DRM_AMDGPU_GEM_METADATA] = do_nothing,
    [DRM_AMDGPU_GEM_WAIT_IDLE] = wait_for_buffer,
    [DRM_AMDGPU_GEM_VA] = do_nothing,
    [DRM_AMDGPU_WAIT_CS] = wait_for_commands,
    [DRM_AMDGPU_GEM_OP] = do_nothing,
    [DRM_AMDGPU_GEM_USERPTR] = refuse,
    [DRM_AMDGPU_WAIT_FENCES] = do_nothing,
    [DRM_AMDGPU_VM] = do_nothing,
};

void drm_shim_driver_init(void)
{
  const char* const name = getenv("AMDGPU_SHIM_CHIP");
  const unsigned count = sizeof(chips) / sizeof(chips[0]);
  while (name && chip < chips + count && strcmp(chip->name, name) != 0)
    ++chip;
  if (chip == chips + count)
  {
    fprintf(stderr, "AMDGPU_SHIM_CHIP is '%s'; it must be navi10 or gfx1100\n", name);
    abort();
  }
  shim_device.bus_type = DRM_BUS_PCI;
  shim_device.driver_name = "amdgpu";
  shim_device.driver_ioctls = ioctls;
  shim_device.driver_ioctl_count = sizeof(ioctls) / sizeof(ioctls[0]);
  shim_device.version_major = 3;
  shim_device.version_minor = 42;

  char text[256];
  snprintf(text, sizeof(text),
           "DRIVER=amdgpu\nPCI_CLASS=30000\nPCI_ID=1002:%04X\nPCI_SUBSYS_ID=1002:0001\nPCI_SLOT_NAME=0000:01:00.0\n",
           chip->device_id);
  drm_shim_override_file(text, "/sys/dev/char/%d:%d/device/uevent", DRM_MAJOR, render_node_minor);
  snprintf(text, sizeof(text), "0x%04x\n", chip->device_id);
  const char* const files[][2] = {{"vendor", "0x1002\n"},
                                  {"device", text},
                                  {"revision", "0x0\n"},
                                  {"subsystem_vendor", "0x1002\n"},
                                  {"subsystem_device", "0x0001\n"}};
  for (unsigned i = 0; i < sizeof(files) / sizeof(files[0]); ++i)
    drm_shim_override_file(files[i][1], "/sys/dev/char/%d:%d/device/%s", DRM_MAJOR, render_node_minor, files[i][0]);
}
