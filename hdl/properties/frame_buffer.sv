// crc16_as_sent: The two bytes following a set are the CRC-16 of its bytes as written, computed separately.
// whole_frames_only: The readable part of the buffer ends with a frame: its end moves only when the last byte of a frame has been written.
// never_overwritten unless HAS_OTHER_FRAMES (frames of other lengths): A frame is written only if the buffer has room for all of it.
reg [15:0] f_crc; initial f_crc = 16'hffff;
reg [7:0] f_byte; reg [3:0] f_cycle; initial f_cycle = 4'd0;
wire [3:0] f_bits = in_tail ? 4'd0 : cycle_at[3] ? {1'b0, cycle_at[2:0]} : 4'd0;
function [15:0] f_crc_of(input [15:0] so_far, input [7:0] value, input [3:0] bits);
    integer i;
    begin
        f_crc_of = so_far;
        for (i = 0; i < 8; i = i + 1)
            if (i < bits) f_crc_of = {f_crc_of[14:0], 1'b0} ^ ((f_crc_of[15] ^ value[7 - i]) ? 16'h1021 : 16'h0000);
    end
endfunction
always @(posedge clock) begin
    f_byte <= set_byte;
    f_cycle <= cycle_at;
    if (byte_end & !in_tail) f_crc <= f_crc_of(f_crc, byte_held, 4'd8);
    if (!writing) f_crc <= 16'hffff;
end
// according to the port: the byte from the set is ready in time, and stays
always @* begin
    assume ((f_cycle < 4'd5) | (f_cycle == 4'd15) | (set_byte == f_byte));
end
always @* begin
    crc16_as_sent: assert (!(byte_end & in_tail & !at[2] & !at[1]) | (byte_held == (at[0] ? f_crc[15:8] : f_crc[7:0])));
    crc16_as_sent_so_far: assert (!writing | (crc == f_crc_of(f_crc, byte_held, f_bits)));
    crc16_as_sent_tail: assert ((cycle_at == 4'd0) | (in_tail == (at[6:3] == TAIL_BLOCK)));
    crc16_as_sent_rest: assert (writing ? (byte_end == (cycle_at == 4'd15)) : ((cycle_at == 4'd0) & !byte_end));
    crc16_as_sent_stays: assert (in_tail | !cycle_at[3] | (byte_held == f_byte));
    crc16_as_sent_bytes: assert (!in_tail | at[2] | at[1] | (cycle_at < 4'd3) | (byte_held == (at[0] ? crc[15:8] : crc[7:0])));
    crc16_as_sent_ends: assert ((cycle_at < 4'd2) | ((is_past == (in_tail & at[2])) & (is_end == (in_tail & (&at[1:0])))));
end
reg f_end; initial f_end = 1'b1;
reg [12:0] f_start; initial f_start = 13'd0;
always @(posedge clock) begin
    f_end <= (byte_end & is_end) | reset;
    f_start <= start_at;
end
always @* begin
    whole_frames_only: assert ((start_at == f_start) | f_end);
    whole_frames_only_begin: assert (!writing | !start);
end
wire [12:0] f_waits = (start_at - read_at) & MASK;
wire [12:0] f_frame = (write_at - start_at) & MASK;
wire f_closed = !writing | ((at[6:3] == TAIL_BLOCK) & at[2]);
// according to the port: a byte is taken only after it is ready
always @* assume (!take | ready);
wire f_settles = writing & f_closed & (cycle_at == 4'd0);
always @* begin
    never_overwritten: assert (HAS_OTHER_FRAMES | !writing | ({1'b0, f_waits} + {1'b0, f_frame} <= {1'b0, MASK}));
    never_overwritten_frame: assert (HAS_OTHER_FRAMES | f_frame == (f_closed ? 13'd0 : {6'd0, at} + 13'd1));
    never_overwritten_at: assert (HAS_OTHER_FRAMES | (at[6:3] < TAIL_BLOCK) | ((at[6:3] == TAIL_BLOCK) & (!at[2] | (at[1:0] == 2'd0) | (!writing & (at[1:0] == 2'd1)))));
    never_overwritten_used: assert (HAS_OTHER_FRAMES | f_settles | (used >= f_waits));
    never_overwritten_took: assert (HAS_OTHER_FRAMES | used <= f_waits + {12'd0, took});
    never_overwritten_room: assert (HAS_OTHER_FRAMES | f_settles | (writing & f_closed & (cycle_at == 4'd1)) | (writing & !f_closed ? f_waits <= MOST_USED : !fits | (f_waits <= MOST_USED)));
end
