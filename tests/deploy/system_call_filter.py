"""Compiles what a unit's SystemCallFilter and RestrictAddressFamilies allow to a filter for `bwrap --seccomp`.

Reads JSON {"calls": [NAME], "families": [NAME]} from standard input, writes BPF to standard output. What is not
allowed fails with EPERM. The library is systemd's own.
"""
import ctypes
import json
import socket
import sys

ALLOW, FAIL_WITH_EPERM, EQUAL = 0x7FFF0000, 0x00050001, 4


class Comparison(ctypes.Structure):
    _fields_ = [("argument", ctypes.c_uint), ("operator", ctypes.c_int), ("a", ctypes.c_uint64), ("b", ctypes.c_uint64)]


seccomp = ctypes.CDLL("libseccomp.so.2")
seccomp.seccomp_init.restype = ctypes.c_void_p
seccomp.seccomp_init.argtypes = [ctypes.c_uint32]
seccomp.seccomp_rule_add_array.argtypes = [
    ctypes.c_void_p, ctypes.c_uint32, ctypes.c_int, ctypes.c_uint, ctypes.POINTER(Comparison)]
seccomp.seccomp_export_bpf.argtypes = [ctypes.c_void_p, ctypes.c_int]


def allow(call, comparisons=()):
    number = seccomp.seccomp_syscall_resolve_name(call.encode())
    if number < 0:  # of another architecture
        return
    array = (Comparison * len(comparisons))(*comparisons)
    if seccomp.seccomp_rule_add_array(context, ALLOW, number, len(comparisons), array) != 0:
        sys.exit(f"system_call_filter.py: {call} cannot be allowed")


allowed = json.load(sys.stdin)
context = seccomp.seccomp_init(FAIL_WITH_EPERM)
for name in allowed["calls"]:
    if name != "socket":
        allow(name)
for family in allowed["families"]:
    allow("socket", [Comparison(0, EQUAL, getattr(socket, family), 0)])
if seccomp.seccomp_export_bpf(context, sys.stdout.fileno()) != 0:
    sys.exit("system_call_filter.py: the filter cannot be written")
