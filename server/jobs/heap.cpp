// How the program's jemalloc begins. It reads this as it is loaded, before main.
//
// Columns are filled once and thrown away. With pages of 4 KiB a virtual machine takes 4 to 17 us
// to map each: a column of a million numbers 35 ms in one call that can ask no budget, and a tenth
// of what jobs take. Pages of 2 MiB take a fiftieth of that, and those that a job has left none.

extern "C" {
// NOLINTNEXTLINE: jemalloc gives the name and takes it as it stands
const char* malloc_conf =
    "thp:always,"            // where the system lets a program ask for such pages
    "narenas:1,"             // all threads take what any of them has freed,
    "oversize_threshold:0,"  // large blocks too
    "dirty_decay_ms:3000,"   // what nobody takes goes back to the system within so long,
    "muzzy_decay_ms:0,"
    "background_thread:true,max_background_threads:1";  // also while nothing is asked
}
