// The program's operator new and delete: malloc's, counted for the job that the thread works on.

#include <malloc.h>

#include <cstdlib>
#include <new>

#include "server/jobs/job_memory.hpp"

namespace {

using tubecut::server::JobMemory;

constexpr std::size_t kHeader = 8;  // the allocator's own bytes next to each block

void* counted(void* block) {
  if (block == nullptr) throw std::bad_alloc();
  try {
    JobMemory::take(malloc_usable_size(block) + kHeader);
  } catch (...) {
    std::free(block);
    throw;
  }
  return block;
}

void* aligned(std::size_t size, std::align_val_t alignment) {
  const auto unit = static_cast<std::size_t>(alignment);
  return counted(std::aligned_alloc(unit, (size + unit - 1) / unit * unit));
}

void release(void* block) noexcept {
  if (block == nullptr) return;
  JobMemory::give(malloc_usable_size(block) + kHeader);
  std::free(block);
}

template <class Get>
void* or_none(Get get) noexcept {
  try {
    return get();
  } catch (...) {
    return nullptr;
  }
}

}  // namespace

// All forms are defined here, because the array and nothrow forms would otherwise be the
// allocator's or a sanitizer's own.
void* operator new(std::size_t size) { return counted(std::malloc(size)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return aligned(size, alignment);
}
void* operator new(std::size_t size, const std::nothrow_t& /*unused*/) noexcept {
  return or_none([size] { return operator new(size); });
}
void* operator new(std::size_t size, std::align_val_t alignment,
                   const std::nothrow_t& /*unused*/) noexcept {
  return or_none([=] { return aligned(size, alignment); });
}
void* operator new[](std::size_t size) { return operator new(size); }
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return aligned(size, alignment);
}
void* operator new[](std::size_t size, const std::nothrow_t& none) noexcept {
  return operator new(size, none);
}
void* operator new[](std::size_t size, std::align_val_t alignment,
                     const std::nothrow_t& none) noexcept {
  return operator new(size, alignment, none);
}
void operator delete(void* block) noexcept { release(block); }
void operator delete(void* block, const std::nothrow_t& /*unused*/) noexcept { release(block); }
void operator delete(void* block, std::size_t) noexcept { release(block); }
void operator delete(void* block, std::align_val_t) noexcept { release(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { release(block); }
void operator delete(void* block, std::align_val_t, const std::nothrow_t& /*unused*/) noexcept {
  release(block);
}
void operator delete[](void* block) noexcept { release(block); }
void operator delete[](void* block, const std::nothrow_t& /*unused*/) noexcept { release(block); }
void operator delete[](void* block, std::size_t) noexcept { release(block); }
void operator delete[](void* block, std::align_val_t) noexcept { release(block); }
void operator delete[](void* block, std::size_t, std::align_val_t) noexcept { release(block); }
void operator delete[](void* block, std::align_val_t, const std::nothrow_t& /*unused*/) noexcept {
  release(block);
}
