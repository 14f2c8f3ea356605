// crc_as_received: The CRC of a frame that is all position is found right exactly if it equals one that is computed apart from it over the bits as sampled.
// error_bits_as_received: F1, and F2 of EnDat 2.2, are the first samples after the start bit of a frame that is all position.
// bits_counted: A frame that is all position is whole after F1, F2, as many position bits as were set and five CRC bits: no sample more or less.
reg f_same; initial f_same = 1'b0;
reg f_open; initial f_open = 1'b0;
reg f_whole; initial f_whole = 1'b0;
reg [6:0] f_count; initial f_count = 7'd0;
reg [4:0] f_crc; initial f_crc = 5'd31;
reg [4:0] f_received; initial f_received = 5'd0;
reg f_f1; initial f_f1 = 1'b0;
reg f_f2; initial f_f2 = 1'b1;
reg [12:0] f_then; initial f_then = 13'd0;
// a frame that is all position, begun at rest, whose settings are held: the properties are about these
wire [12:0] f_now = {payload_bits, has_f1, has_f2, has_parameter, has_supplement, going_on, infos};
wire f_simple = has_f1 & !has_parameter & !has_supplement & !going_on & (infos == 2'd0);
wire f_rest = (field == FIELD_DONE) & !shift_now & !last_payload & !take_crc & !last_taken & !waiting;
wire f_held = f_same & (f_now == f_then);
wire f_asked = (payload_bits != 6'd0) & (payload_bits <= 6'd48);
wire [6:0] f_covered = {1'b0, payload_bits} + 7'd1 + {6'd0, has_f2};
wire [6:0] f_of_crc = f_count - f_covered;
// x^5 + x^3 + x + 1
function [4:0] f_step (input [4:0] crc, input value);
    f_step = {crc[3], crc[2] ^ crc[4] ^ value, crc[1], crc[0] ^ crc[4] ^ value, crc[4] ^ value};
endfunction
// the register of the serial check after the bits of the CRC that have come
function [4:0] f_after (input [4:0] crc, input [4:0] received, input [6:0] bits);
    integer f_i;
    begin
        f_after = crc;
        for (f_i = 4; f_i >= 0; f_i = f_i - 1)
            if (f_i < bits) f_after = f_step(f_after, received[f_i]);
    end
endfunction
always @(posedge clock) begin
    f_same <= f_held;
    if (f_open & sample) begin
        f_count <= f_count + 7'd1;
        if (f_count < f_covered) f_crc <= f_step(f_crc, level);
        else f_received <= {f_received[3:0], level};
        if (f_count == 7'd0) f_f1 <= level;
        if (has_f2 & (f_count == 7'd1)) f_f2 <= level;
        if (f_count == f_covered + 7'd4) begin
            f_open <= 1'b0;
            f_whole <= 1'b1;
        end
    end
    if (start_found) f_open <= 1'b1;
    if (start) begin
        f_same <= f_simple & f_rest & f_asked;
        f_then <= f_now;
        f_count <= 7'd0;
        f_crc <= 5'd31;
        f_received <= 5'd0;
        f_f1 <= 1'b0;
        f_f2 <= 1'b1;
    end
    if (start | aborts | reset | start_supplement) begin
        f_open <= 1'b0;
        f_whole <= 1'b0;
    end
    if (reset | aborts | start_supplement) f_same <= 1'b0;
end
wire f_answer = (field == FIELD_F1) | (field == FIELD_F2) | (field == FIELD_PAYLOAD) | (field == FIELD_CRC);
always @* begin
    crc_as_received: assert (!(f_held & done) | (serial_ok == (f_received == ~f_crc)));
    crc_as_received_lemma_register: assert (!(f_held & (f_open | f_whole)) | (~serial_crc == f_after(f_crc, f_received, f_of_crc[6] ? 7'd0 : f_of_crc)));
    error_bits_as_received: assert (!(f_held & done) | ((f1 == f_f1) & (f2 == f_f2)));
    error_bits_as_received_lemma: assert (!(f_held & (f_open | f_whole)) | (((f_count == 7'd0) | (f1_bit == f_f1)) & (f2_bit == f_f2)));
    bits_counted: assert (!(f_held & done) | (f_whole & (f_count == f_covered + 7'd5)));
    if (f_held) begin
        bits_counted_lemma_then: assert (f_simple & f_asked & !in_info & (infos_left == 2'd0));
        bits_counted_lemma_open: assert (f_open == f_answer);
        bits_counted_lemma_whole: assert (!f_whole | (!f_open & (field == FIELD_DONE) & (f_count == f_covered + 7'd5)));
        bits_counted_lemma_done: assert (!(last_taken | waiting | done_now) | f_whole);
        if (f_open) begin
            bits_counted_lemma_left: assert ({1'b0, left} == {1'b0, f_covered} + 8'd6 - {1'b0, f_count});
            bits_counted_lemma_f1: assert ((field == FIELD_F1) == (f_count == 7'd0));
            bits_counted_lemma_f2: assert ((field == FIELD_F2) == (has_f2 & (f_count == 7'd1)));
            bits_counted_lemma_crc: assert ((field == FIELD_CRC) == (f_count >= f_covered));
            bits_counted_lemma_end: assert (f_count <= f_covered + 7'd4);
        end else if (!f_whole) begin
            bits_counted_lemma_before: assert ((field == FIELD_SKIP) | (field == FIELD_START) | (field == FIELD_DONE));
            if (field != FIELD_DONE) begin
                bits_counted_lemma_clear: assert (f_count == 7'd0);
                crc_as_received_lemma_clear: assert ((f_crc == 5'd31) & (~serial_crc == 5'd31));
                error_bits_as_received_lemma_clear: assert (f2_bit & f_f2);
            end
        end
        if (field == FIELD_START) bits_counted_lemma_start: assert (left == f_covered + 7'd6);
        if (field == FIELD_SKIP) bits_counted_lemma_skip: assert ((left == f_covered + 7'd21 - {3'd0, covered}) & (covered <= 4'd14) & (skip_rounds == 2'd0) & !shift_now & !align & !take_crc & !last_payload);
    end
end
