// How the program's jemalloc begins. It reads this as it is loaded, before main.
//
// Columns are filled once and then freed. With pages of 4 KiB a virtual machine takes 4 to 17 us to
// map each page: 35 ms for a column of a million numbers, in one call that cannot check a budget,
// and a tenth of a job's time. Pages of 2 MiB take a fiftieth of that, and pages that a job has
// left cost nothing.

extern "C" {
// NOLINTNEXTLINE: jemalloc requires this name and type
const char* malloc_conf =
    "thp:always,"            // if the system lets a program request such pages
    "narenas:1,"             // all threads reuse the blocks that any of them has freed,
    "oversize_threshold:0,"  // large blocks too
    "dirty_decay_ms:3000,"   // unused memory goes back to the system after this time,
    "muzzy_decay_ms:0,"
    "background_thread:true,max_background_threads:1";  // also while no request runs
}
