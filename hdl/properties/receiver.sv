// crc_as_received: The CRC of a frame that is all position is reported right exactly if a serial register gets the same result from the sampled bits, at every width and command.
// error_bits_as_received: F1, and F2 of EnDat 2.2, are the first samples after the start bit of a frame that is all position.
// bits_counted: A frame that is all position ends after F1, F2, the configured number of position bits and five CRC bits: no sample more or less.
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
wire f_alone = !low_separator & !separator_then & !new_block;
wire f_rest = (field == FIELD_DONE) & !shifting & !last_payload & !take_crc & !last_taken & !waiting & f_alone;
wire f_held = f_same & (f_now == f_then);
wire f_asked = (payload_bits != 6'd0) & (payload_bits <= 6'd48);
wire [6:0] f_covered = {1'b0, payload_bits} + 7'd1 + {6'd0, has_f2};
wire [6:0] f_of_crc = f_count - f_covered;
wire [2:0] f_crc_bits = f_of_crc[6] ? 3'd0 : f_of_crc[2:0];
// bits that the word has taken, and places for them
wire [6:0] f_in = (f_of_crc[6] ? f_count : f_covered) - {6'd0, shifting};
wire [6:0] f_size = in5 ? 7'd5 : in20 ? 7'd20 : in35 ? 7'd35 : 7'd50;
reg f_taken; initial f_taken = 1'b0;
// x^5 + x^3 + x + 1
function [4:0] f_step (input [4:0] crc, input value);
    f_step = {crc[3], crc[2] ^ crc[4] ^ value, crc[1], crc[0] ^ crc[4] ^ value, crc[4] ^ value};
endfunction
function [3:0] f_mod_15 (input [6:0] bits);
    f_mod_15 = (bits >= 7'd45) ? bits - 7'd45 : (bits >= 7'd30) ? bits - 7'd30 : (bits >= 7'd15) ? bits - 7'd15 : bits;
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
    if (take_crc) f_taken <= 1'b1;
    if (start) begin
        f_same <= f_simple & f_rest & f_asked;
        f_then <= f_now;
        f_count <= 7'd0;
        f_crc <= 5'd31;
        f_received <= 5'd0;
        f_f1 <= 1'b0;
        f_f2 <= 1'b1;
        f_taken <= 1'b0;
    end
    if (start | aborts | reset | start_supplement) begin
        f_open <= 1'b0;
        f_whole <= 1'b0;
    end
    if (reset | aborts | start_supplement | (SWAPS & put)) f_same <= 1'b0;
end
wire f_answer = (field == FIELD_F1) | (field == FIELD_F2) | (field == FIELD_PAYLOAD) | (field == FIELD_CRC);
always @* begin
    crc_as_received: assert (!(f_held & done) | (crc_ok == (f_received == ~f_crc)));
    crc_as_received_lemma_bits: assert (!(f_held & (f_open | f_whole)) | (((crc_bits ^ f_received) & ~(5'h1f << f_crc_bits)) == 5'd0));
    crc_as_received_lemma_equal: assert (!(f_held & done) | (crc_equal == (crc_bits == crc_calc)));
    crc_as_received_lemma_taken: assert (!(f_held & f_taken) | (crc_calc == ~f_crc));
    if (f_held & (f_open | f_whole)) begin
        crc_as_received_lemma_when: assert ((f_count >= f_covered) == (last_payload | take_crc | f_taken));
        crc_as_received_lemma_soon: assert (!last_payload | ((f_count == f_covered) & !take_crc & !f_taken));
        crc_as_received_lemma_then: assert (!take_crc | ((f_count <= f_covered + 7'd1) & !f_taken & !shifting));
        crc_as_received_lemma_shift: assert (!shifting | ((f_count != 7'd0) & !f_taken));
        if (!f_taken) begin
            crc_as_received_lemma_word: assert (f_crc == (shifting ? f_step(~crc_crc, bit_held) : ~crc_crc));
            crc_as_received_lemma_zeros: assert ((word & ~(50'h3ffffffffffff << (f_size - f_in))) == 50'd0);
            crc_as_received_lemma_above: assert ((word >> f_size) == 50'd0);
            crc_as_received_lemma_count: assert (covered == f_mod_15(f_in));
            crc_as_received_lemma_still: assert (!align);
        end
    end
    error_bits_as_received: assert (!(f_held & done) | ((f1 == f_f1) & (f2 == f_f2)));
    error_bits_as_received_lemma: assert (!(f_held & (f_open | f_whole)) | (((f_count == 7'd0) | (f1_bit == f_f1)) & (f2_bit == f_f2)));
    bits_counted: assert (!(f_held & done) | (f_whole & (f_count == f_covered + 7'd5)));
    if (f_held) begin
        bits_counted_lemma_then: assert (f_simple & f_asked & !in_info & (infos_left == 2'd0) & f_alone);
        bits_counted_lemma_open: assert (f_open == f_answer);
        bits_counted_lemma_whole: assert (!f_whole | (!f_open & (field == FIELD_DONE) & (f_count == f_covered + 7'd5)));
        bits_counted_lemma_done: assert (!(last_taken | waiting | is_complete) | f_whole);
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
                crc_as_received_lemma_clear: assert ((f_crc == 5'd31) & (word == 50'd0) & !f_taken & !shifting & !last_payload & !take_crc & !align);
                error_bits_as_received_lemma_clear: assert (f2_bit & f_f2);
            end
        end
        if (field == FIELD_START) bits_counted_lemma_start: assert ((left == f_covered + 7'd6) & (covered == 4'd0));
        if (field == FIELD_SKIP) bits_counted_lemma_skip: assert ((left == f_covered + 7'd21 - {3'd0, covered}) & (covered <= 4'd14) & (skip_rounds == 2'd0) & !shifting & !align & !take_crc & !last_payload);
    end
end
// with SWAPS
// word_kept: The position that the receiver gets after a frame stays in it until the next frame.
reg [52:0] f_given;
reg f_keeps; initial f_keeps = 1'b0;
always @(posedge clock) begin
    if (put) f_given <= {put_word, put_crc};
    if (put) f_keeps <= f_rest & !align;
    if (start | reset) f_keeps <= 1'b0;
end
always @* if (f_keeps) begin
    word_kept: assert ({payload, crc_bits} == f_given);
    word_kept_lemma: assert (f_rest & !align);
end
// end
