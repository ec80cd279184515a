/* With the sanitizers: what MPI takes when it starts and when it ends, and keeps until the process is gone, is no leak
   of ours, and no stack of it is read when a run ends.  What its plug-ins take on the way is known by their names
   (lsan.supp) as long as they stay loaded: so a stack's innermost calls say it, and none has to be walked to its end.
 */
#include <mpi.h>
#include <sanitizer/lsan_interface.h>

int MPI_Init_thread(int *argc, char ***argv, int required, int *provided)
{
  __lsan_disable();
  const int error = PMPI_Init_thread(argc, argv, required, provided);

  __lsan_enable();
  return error;
}

int MPI_Finalize(void)
{
  __lsan_disable();
  const int error = PMPI_Finalize();

  __lsan_enable();
  return error;
}

/* Nothing is unloaded. */
int dlclose(void *library)
{
  (void)library;
  return 0;
}
