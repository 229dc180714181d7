/* A plugin of QEMU that counts the instructions from the entry of one function to that of another, each time:
 *
 *   qemu-x86_64 -plugin libcount_plugin.so,out=FILE,begin=OFFSET,end=OFFSET PROGRAM
 *
 * An OFFSET is a function's address less that of the program's first code, in decimal. FILE gets a line a
 * count. For programs of one thread. Debian's QEMU can load plugins and ships no header for them, so what is
 * used of version 1 of its interface is declared here. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct qemu_plugin_tb;
struct qemu_plugin_insn;
typedef uint64_t qemu_plugin_id_t;
extern void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id,
                                                  void (*translated)(qemu_plugin_id_t,
                                                                     struct qemu_plugin_tb*));
extern size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb* block);
extern struct qemu_plugin_insn* qemu_plugin_tb_get_insn(const struct qemu_plugin_tb* block, size_t index);
extern uint64_t qemu_plugin_insn_vaddr(const struct qemu_plugin_insn* instruction);
extern void qemu_plugin_register_vcpu_insn_exec_cb(struct qemu_plugin_insn* instruction,
                                                   void (*executed)(unsigned int, void*), int flags,
                                                   void* data);
extern void qemu_plugin_register_vcpu_insn_exec_inline(struct qemu_plugin_insn* instruction, int operation,
                                                       void* counter, uint64_t immediate);
extern uint64_t qemu_plugin_start_code(void);

__attribute__((visibility("default"))) int qemu_plugin_version = 1;

enum { kNoRegisters = 0, kAdd = 0 };

static FILE* out;
static uint64_t begin;
static uint64_t end;
static uint64_t executed;
static uint64_t began_at;
static int counting;

static void at_begin(unsigned int processor, void* data) {
  (void)processor;
  (void)data;
  began_at = executed;
  counting = 1;
}

static void at_end(unsigned int processor, void* data) {
  (void)processor;
  (void)data;
  if (counting) {
    fprintf(out, "%llu\n", (unsigned long long)(executed - began_at));
    fflush(out);
  }
  counting = 0;
}

static void translated(qemu_plugin_id_t id, struct qemu_plugin_tb* block) {
  (void)id;
  for (size_t i = 0; i < qemu_plugin_tb_n_insns(block); ++i) {
    struct qemu_plugin_insn* const instruction = qemu_plugin_tb_get_insn(block, i);
    const uint64_t offset = qemu_plugin_insn_vaddr(instruction) - qemu_plugin_start_code();
    qemu_plugin_register_vcpu_insn_exec_inline(instruction, kAdd, &executed, 1);
    if (offset == begin) qemu_plugin_register_vcpu_insn_exec_cb(instruction, at_begin, kNoRegisters, NULL);
    if (offset == end) qemu_plugin_register_vcpu_insn_exec_cb(instruction, at_end, kNoRegisters, NULL);
  }
}

/* Not 0: QEMU says that the plugin cannot be loaded, and ends. */
__attribute__((visibility("default"))) int qemu_plugin_install(qemu_plugin_id_t id, const void* info,
                                                               int count, char** arguments) {
  (void)info;
  for (int i = 0; i < count; ++i) {
    const char* const value = strchr(arguments[i], '=') != NULL ? strchr(arguments[i], '=') + 1 : "";
    if (strncmp(arguments[i], "out=", 4) == 0) out = fopen(value, "w");
    if (strncmp(arguments[i], "begin=", 6) == 0) begin = strtoull(value, NULL, 10);
    if (strncmp(arguments[i], "end=", 4) == 0) end = strtoull(value, NULL, 10);
  }
  if (out == NULL || begin == 0 || end == 0) return 1;
  qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
  return 0;
}
