// does_what_was_asked: The bank gets address and direction of the current transfer.
// writes_the_word: A written word is that of the transfer.
// bytes_in_order: The bytes of a word are read in their order, each once.
// answer_has_been_done: A transfer ends without an error only if it is allowed and the bank has done it.
// read_is_what_the_bank_gave: A read returns the four bytes of the bank.
// error_does_nothing: A transfer that ends with an error is a refused one, and changes nothing.
// no_answer_without_a_transfer: No answer comes unless a transfer was requested in the cycle before.
// one_cycle_of_answer: An answer lasts one cycle.
// answers_in_time: A transfer is answered within 50 cycles, if the bank answers each access within four.
    // The bank has begun what this transfer asks for; the last byte of it; the bytes that it gave.
    reg f_done = 0;
    reg [1:0] f_lanes = 0;
    reg [31:0] f_word = 0;
    reg [5:0] f_waits = 0;
    // Configuration words pass in one access, as written words do; others are read byte by byte.
    wire f_config = (t_address[10:7] == 2) & !t_address[2];
    wire p_config = (p_asked[10:7] == 2) & !p_asked[2];
    wire f_words = \u_words.access_strobe  | (\u_words.settle  != 0) | f_busy | \u_words.end_strobe ;
    wire f_whole = \u_words.whole ;
    wire f_mine = busy & !t_left;
    always @(posedge clock) begin
        if (done && !f_write) f_word <= {f_word[23:0], read_byte};
        if (!t_on | t_answer) begin
            f_done <= 0;
            f_lanes <= 0;
        end else if (access & !t_left) begin
            f_done <= 1;
            f_lanes <= lane;
        end
        f_waits <= (t_on & p_on & !t_answer & !p_answer) ? f_waits + 1 : 0;
    end
    // What a master is promised.
    always @* begin
        if (t_on && access && !t_left) begin
            does_what_was_asked: assert (word_address == t_address && write == t_write);
            writes_the_word: assert (!write || write_data == t_word);
            bytes_in_order: assert (lane == (f_done ? f_lanes + 2'd1 : 2'd0));
        end
        if (t_on && t_answer && !t_error) begin
            answer_has_been_done: assert (f_done && !t_refused);
            read_is_what_the_bank_gave: assert (t_write || f_config || (f_lanes == 3 && t_read == f_word));
        end
        if (t_on && t_answer && t_error) begin
            error_does_nothing: assert (!f_done && t_refused);
        end
        no_answer_without_a_transfer: assert (!t_answer || p_held);
        one_cycle_of_answer: assert (!(t_answer && p_answer));
        answers_in_time: assert (f_waits <= 50);
    end
    // What holds between front, word and bank in every state that can be reached: induction needs it.
    always @* begin
        one_place: assert (\u_words.access_strobe  + (\u_words.settle  != 0) + f_busy + \u_words.end_strobe  <= 1);
        busy_is_so: assert (busy == (request | f_words) && !(request && f_words));
        if (f_busy) begin
            bank_has_it: assert (f_write == write && f_address == word_address);
        end
        if (f_mine) begin
            mine_is_asked: assert (word_address == p_asked && write == p_writes && !p_refused && p_held);
            mine_is_new: assert (f_done || request || \u_words.settle  != 0 || (\u_words.access_strobe  && lane == 0));
        end
        if (f_done) begin
            done_is_mine: assert ((f_mine || (t_answer && !t_error)) && !request && \u_words.settle  == 0 && p_on);
        end
        if (t_answer) begin
            answer_is_known: assert (!busy && (t_error ? p_refused : f_done));
        end
        error_is_answer: assert (!t_error || t_answer);
        if (f_mine && f_words) begin
            whole_is_known: assert (f_whole == (p_writes | p_config));
            data_is_asked: assert (!(p_writes && !f_done) || write_data == p_word);
        end
        if (f_done && f_mine && f_whole) begin
            whole_is_one: assert (lane == 0 && f_lanes == 0 && !\u_words.access_strobe );
        end
        if (f_done && f_mine && !f_whole) begin
            if (f_busy) begin lanes_in_bank: assert (lane == f_lanes); end
            if (\u_words.access_strobe ) begin lanes_next: assert (lane == f_lanes + 2'd1 && f_lanes != 3); end
            if (\u_words.end_strobe ) begin lanes_end: assert (f_lanes == 3 && f_word == t_read); end
            if (lane == 1) begin word_1: assert (f_word[7:0] == t_read[7:0]); end
            if (lane == 2) begin word_2: assert (f_word[15:0] == t_read[15:0]); end
            if (lane == 3) begin word_3: assert (f_word[23:0] == t_read[23:0]); end
        end
        if (t_answer && !t_error && !p_writes && !p_config) begin
            word_at_last: assert (f_lanes == 3 && f_word == t_read);
        end
    end
