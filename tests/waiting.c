/* Preloaded where a test runs more than one rank.  OpenMPI's ranks poll for each other's messages and give the core
   away by sched_yield() in between, which leaves it at once to whatever else computes there and gets it back late:
   beside one other test two ranks took ten times as long, four a hundred times.  Here they sleep for a moment instead.
 */
#include <time.h>

int sched_yield(void); /* as in sched.h */

int sched_yield(void)
{
  const struct timespec moment = {0, 1000};

  nanosleep(&moment, NULL);
  return 0;
}
