//! Configurations that have every key between them.

/// Cards and a receiver that have every key between them, and what is left of a card without any table that may be missing.
pub const BASES: [&str; 8] = [
    // Whatever a card with a UART may have.
    "name = \"whole\"\nwith = [\"svd\", \"rdl\"]\n[clock]\nsystem_hz = 100_000_000\n[endat]\nclock_hz = 4_000_000\ncalibration_hz = 300_000\ntst_ns = 2_000\n\
     filter_ns = 20\nstart_window_ns = 60\ntcal_max_ns = 6_000\nrecovery_min_ns = 12_000\nrecovery_max_ns = 20_000\ncable_m = 30\n\
     [[channel]]\nencoder = \"one\"\nprotocol = \"endat\"\nposition_bits = 25\ncommand = \"111000\"\nenabled = false\ndivider = 2\n\
     sources = [\"pin\"]\n[[channel]]\nposition_bits = 25\ncommand = \"000111\"\n[trigger]\nsample_hz = 100\nsources = [\"timer\"]\n\
     [link]\nbaud = 2_000_000\nread_hz = 50\n[host]\nbus = \"uart\"\n[service]\nparts = [\"requests\", \"diagnosis\", \"continuous\"]\n\
     infos = [0x4C]\n[line]\nparts = [\"alignment\", \"margin\"]\nphase = \"frame\"\nfixed_delay_ns = 400\ndrift_limit_ns = 40\nsamples = 3\n\
     [outputs]\nparts = []\n[safety]\nparts = [\"second_interface\", \"error_test\"]\nerror_test_ms = 50\nupset_guards = true\nrestore = false\n\
     [stream]\nfifo_bytes = 1024\nstart = \"push\"\nadditional_data = true\n[device]\ninitial_values = true\n[board]\nname = \"papilio_pro\"\n\
     [pins]\ntrigger_i = \"A0\"\n",
    "name = \"base\"\n[clock]\nsystem_hz = 100_000_000\n[endat]\nclock_hz = 4_000_000\n[[channel]]\nposition_bits = 25\n\
     command = \"111000\"\n[trigger]\nsample_hz = 100\n[host]\nbus = \"apb\"\nbase_address = 0x2000\n[outputs]\n\
     parts = [\"position\", \"interrupt\"]\n",
    "name = \"outside\"\n[clock]\nsystem_hz = 100_000_000\n[endat]\nclock_hz = 4_000_000\n[[channel]]\nposition_bits = 25\nlinear = false\n\
     command = \"111000\"\n[trigger]\nsample_hz = 100\n[host]\nbus = \"spi\"\nsck_hz = 1_000_000\n",
    "name = \"other\"\n[clock]\nsystem_hz = 100_000_000\n[[channel]]\nprotocol = \"t_format\"\nbit_hz = 5_000_000\nrequest = 0\n\
     reply_gap_us = 30\nfield_gap_us = 3\nfilter_ns = 20\n[trigger]\nsample_hz = 100\n[host]\nbus = \"apb\"\n",
    "name = \"serial\"\n[clock]\nsystem_hz = 100_000_000\n[[channel]]\nprotocol = \"ssi\"\nposition_bits = 25\nclock_hz = 500_000\n\
     single_turn_bits = 25\nmulti_turn_bits = 0\n\
     code = \"gray\"\nparity = \"odd\"\ntwice = true\nbit_delay_ns = 300\ntst_ns = 2_000\nfilter_ns = 20\nrecovery_min_ns = 12_000\nrecovery_max_ns = 20_000\ncable_m = 20\n\
     bits_before = [\"ignored\"]\nbits_after = [\"alarm\"]\nend_low = true\n[trigger]\nsample_hz = 100\n[host]\nbus = \"apb\"\n",
    // A board with few pins.
    "name = \"few_pins\"\n[clock]\nsystem_hz = 30_000_000\n[endat]\nclock_hz = 3_000_000\n[[channel]]\nposition_bits = 25\n\
     command = \"111000\"\n[trigger]\nsample_hz = 100\n[host]\nbus = \"spi\"\n[board]\nname = \"icebreaker\"\n[pins]\n",
    "name = \"least\"\n[clock]\nsystem_hz = 100_000_000\n[endat]\nclock_hz = 4_000_000\n[[channel]]\nposition_bits = 25\n\
     command = \"111000\"\n[trigger]\nsample_hz = 100\n[host]\nbus = \"axi_lite\"\n[service]\n[line]\n[outputs]\n[safety]\n[stream]\n",
    // Last: a card takes more keys of its tables.
    "name = \"receiver\"\n[host]\nbus = \"dsp\"\n[[channel]]\nprotocol = \"t_format\"\nencoder = \"one\"\nbit_hz = 2_500_000\n\
     request = 6\nreply_gap_us = 30\nfield_gap_us = 3\nfilter_cycles = 2\n[safety]\nupset_guards = true\n[device]\ninitial_values = false\n",
];
